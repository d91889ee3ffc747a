"""Models with sensors, and how the tests of this folder take what they tell."""

from bullet_sim.pose import IDENTITY, Pose

EARTH = """<sdf version="1.6"><world name="default">
  <physics type="ode"><max_step_size>0.001</max_step_size>
    <real_time_update_rate>0</real_time_update_rate></physics>
  <spherical_coordinates><surface_model>EARTH_WGS84</surface_model>
    <latitude_deg>60</latitude_deg><longitude_deg>10</longitude_deg><elevation>50</elevation>
    <heading_deg>{heading}</heading_deg></spherical_coordinates></world></sdf>"""
WALL = """<model name="wall"><static>true</static><link name="l"><pose>2.05 0 1 0 0 0</pose>
  <collision name="c"><laser_retro>{retro}</laser_retro>
  <geometry><box><size>0.1 8 2</size></box></geometry></collision></link></model>"""
ACROSS = "<samples>3</samples><min_angle>-0.5</min_angle><max_angle>0.5</max_angle>"


def eye(plugin: str, tags: str = "", across: str = ACROSS, up: str = "", rate: float = 10,
        ray: str = "<range><min>0.1</min><max>5</max></range>") -> str:
    """A ray sensor, 1 m above the ground, that looks along x."""
    vertical = f"<vertical>{up}</vertical>" if up else ""
    return f"""<model name="eye"><static>true</static><link name="l"><pose>0 0 1 0 0 0</pose>
      <sensor name="s" type="ray"><update_rate>{rate}</update_rate>
      <ray><scan><horizontal>{across}</horizontal>{vertical}</scan>{ray}</ray>
      <plugin name="p" filename="{plugin}">{tags}</plugin></sensor></link></model>"""


def hector(kind: str, tags: str = "") -> str:
    """Two links that stand still, and a plugin of hector_gazebo in the model."""
    return f"""<model name="bot"><static>true</static><link name="base"/>
      <link name="mast"><pose>0 0 2 0 0 0</pose></link>
      <plugin name="p" filename="libhector_gazebo_ros_{kind}.so">{tags}</plugin></model>"""


def take(bench, topic: str, text: str, seconds: float = 0.3, pose: Pose = IDENTITY) -> list:
    """What comes on a topic of a model, from its beginning."""
    bench.spawn(text, pose)
    messages = bench.listen(topic)
    bench.run(seconds)
    return messages


def look(bench, topic: str, model: str, seconds: float = 0.15, retro: float = 0.0) -> list:
    """What comes on a topic of an `eye` in front of a wall, 2 m away."""
    bench.spawn(WALL.format(retro=retro))
    return take(bench, topic, model, seconds)


def xyz(vector) -> list[float]:
    """The three numbers of a message."""
    return [vector.x, vector.y, vector.z]


def turn(quaternion) -> list[float]:
    """The four numbers of a message."""
    return [quaternion.x, quaternion.y, quaternion.z, quaternion.w]
