"""Contacts become balls and arrows, and go away again."""

import runpy
from pathlib import Path

import pytest
import rospy
from gazebo_msgs.msg import ContactsState, ContactState
from geometry_msgs.msg import Vector3, Wrench
from visualization_msgs.msg import Marker

from bullet_sim_ros.contact_markers import LONGEST, to_markers
from bullet_sim_ros.without_master import without_master

PROGRAM = Path(__file__).resolve().parents[1] / "scripts/contact_markers"


def contacts(*forces):
    message = ContactsState()
    message.header.frame_id = "world"
    message.states = [ContactState(contact_positions=[Vector3(1, 2, 3)],
                                   contact_normals=[Vector3(0, 0, 1)],
                                   wrenches=[Wrench(force=Vector3(0, 0, force))])
                      for force in forces]
    return message


def test_a_ball_and_an_arrow_for_each_contact():
    # conforms: contact_markers
    ball, arrow = to_markers(contacts(5.0), "bumper").markers
    assert ball.ns == "bumper" and 0 < ball.lifetime.to_sec() < 1
    assert (ball.type, ball.header.frame_id) == (Marker.SPHERE, "world")
    assert (ball.pose.position.x, ball.pose.position.z) == (1, 3)
    assert arrow.type == Marker.ARROW
    assert arrow.points[1].z - arrow.points[0].z == pytest.approx(0.1)


def test_a_great_force_does_not_fill_the_screen():
    arrow = to_markers(contacts(1e6), "bumper").markers[1]
    assert arrow.points[1].z - arrow.points[0].z == LONGEST


def test_ids_are_unique_and_no_contact_leaves_nothing():
    ids = [marker.id for marker in to_markers(contacts(1.0, 2.0), "b").markers]
    assert len(set(ids)) == 4
    assert to_markers(contacts(), "b").markers == []


@pytest.mark.parametrize("words, topics", [([], ["/bumper_states"]), (["/a", "b"], ["/a", "/b"])])
def test_the_program_listens_to_the_topics_it_is_told(monkeypatch, words, topics):
    # conforms: contact_markers, contact_markers/TOPIC
    monkeypatch.setattr("sys.argv", ["contact_markers", *words])
    monkeypatch.setattr(rospy, "init_node", lambda _name, anonymous: None)
    monkeypatch.setattr(rospy, "spin", lambda: None)
    with without_master() as graph:
        runpy.run_path(str(PROGRAM), run_name="__main__")
        for topic in topics:
            for subscriber in graph.topics[topic].subscribers:
                subscriber.take(contacts(5.0))
        shown = [message.markers[0].ns for message in graph.topics["/contact_markers"].messages]
    assert shown == [topic.strip("/") for topic in topics]
