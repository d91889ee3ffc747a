from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        Node(package="learning_topic", executable="person_subscriber", name="talker"),
        Node(package="learning_topic", executable="person_publisher", name="listener"),
    ])
