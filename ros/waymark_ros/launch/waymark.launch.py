"""Starts the node: ros2 launch waymark_ros waymark.launch.py map:=/path/site.gpkg start:=0,0,0"""
import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

# Arguments that replace what the file of parameters says, where they are given.
TEXTS = {"map": "Map of the site (.gpkg)",
         "method": "ekf, ukf, pf, global or odometry",
         "start": "X,Y,YAW in the map frame, or none"}


def make_node(context):
    value = {name: LaunchConfiguration(name).perform(context) for name in [*TEXTS, "params", "use_sim_time"]}
    given = {name: value[name] for name in TEXTS if value[name]}
    given["use_sim_time"] = value["use_sim_time"].lower() == "true"
    return [Node(package="waymark_ros", executable="waymark_node", name="waymark", output="screen",
                 parameters=[value["params"], given])]


def generate_launch_description():
    defaults = os.path.join(get_package_share_directory("waymark_ros"), "config", "waymark.yaml")
    return LaunchDescription([
        *[DeclareLaunchArgument(name, default_value="", description=text) for name, text in TEXTS.items()],
        DeclareLaunchArgument("params", default_value=defaults, description="File of parameters"),
        DeclareLaunchArgument("use_sim_time", default_value="false", description="Follow /clock"),
        OpaqueFunction(function=make_node),
    ])
