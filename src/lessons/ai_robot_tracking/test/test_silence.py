"""Why no image comes: the topics that exist now, or how to start the course."""

from ai_robot_tracking.detection.silence import why_silent

IMAGE, SCAN = "sensor_msgs/Image", "sensor_msgs/LaserScan"
RUNNING = [["/camera/rgb/image_raw", IMAGE], ["/scan", SCAN], ["/detector/annotated", IMAGE]]


def test_another_topic_is_meant():
    assert why_silent("/wrong", RUNNING, "/detector") == (
        "no image on /wrong: nobody publishes it. Topics with images: /camera/rgb/image_raw. End "
        "this program and start it with one of them: image:=TOPIC")


def test_a_topic_of_another_type():
    assert why_silent("/scan", RUNNING, "/detector").startswith(
        "no image on /scan: it carries messages of type sensor_msgs/LaserScan. Topics with images: "
        "/camera/rgb/image_raw. ")


def test_without_a_simulator():
    for published in ([], RUNNING[1:]):
        assert why_silent("/wrong", published, "/detector").endswith(
            "nobody publishes images. Start the course in another terminal: roslaunch "
            "ai_robot_tracking start_tracking.launch; this program then goes on by itself")


def test_images_that_are_only_late():
    assert why_silent("/camera/rgb/image_raw", RUNNING, "/detector") == ""
