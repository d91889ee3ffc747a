#!/usr/bin/env python3
"""Takes the pictures of the page that the READMEs show: no test.

    roslaunch learning_topic 0course.launch gui:=false
    roslaunch sim_viewer viewer.launch control:=true
    python3 src/sim/sim_viewer/test/page_picture.py [--out FILE]

and for that of the tab RViz:

    roslaunch urdf02_gazebo demo02_obstacles.launch
    roslaunch nav_demo nav05_test.launch rviz:=false
    rosrun sim_viewer rviz_page -d $(rospack find nav_demo)/config/nav.rviz _control:=true
    python3 src/sim/sim_viewer/test/page_picture.py --rviz [--out FILE]

The page's address comes from the parameter /sim_viewer/url or /rviz_page/url.
"""

import argparse
import time
from pathlib import Path

import cv2
import rosgraph
from chromium import Browser, Page

IMAGES = Path(__file__).resolve().parents[1] / "images"
SIZE_PX = (1280, 640)
DRIVEN = 1.5  # s, so that the robot has left its start
DRAWN = 3.0  # s, in which a processor has drawn what stands in the 3D view
NAVIGATED = 5.0  # s, so that the robot is on its way
GOAL_PX = (900, 180), (940, 180)  # where the drag begins and ends


def drive(page: Page) -> None:
    """The robot has driven a little."""
    page.wait_for("document.querySelector('#drive-topic')?.value == '/cmd_vel'")
    page.wait_for("document.querySelectorAll('.views option').length > 1")
    time.sleep(DRAWN)
    page.key("w", True)
    page.wait_for("document.querySelector('#drive-state').dataset.state == 'driving'")
    time.sleep(DRIVEN)


def navigate(page: Page) -> None:
    """The robot is on its way to a goal."""
    page.wait_for("document.querySelector('[data-name=Footprint]')?.dataset.level == 'ok'")
    time.sleep(DRAWN)
    page.evaluate("document.querySelector('#rviz-tool-goal').click()")
    begin, end = GOAL_PX
    for kind, place in (("Pressed", begin), ("Moved", end), ("Released", end)):
        page.mouse(kind, *place)
    time.sleep(NAVIGATED)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rviz", action="store_true", help="the tab RViz")
    parser.add_argument("--out", type=Path)
    given = parser.parse_args()
    node, tab, do = (("rviz_page", "rviz", navigate) if given.rviz
                     else ("sim_viewer", "drive", drive))
    out = given.out or IMAGES / ("rviz.png" if given.rviz else "page.png")
    browser = Browser()
    try:
        page = browser.open(f"{rosgraph.Master('/page_picture').getParam(f'/{node}/url')}#{tab}")
        page.resize(*SIZE_PX)
        do(page)
        cv2.imwrite(str(out), page.picture(), [cv2.IMWRITE_PNG_COMPRESSION, 9])
        if not given.rviz:
            page.key("w", False)
    finally:
        browser.close()
    print(out)


if __name__ == "__main__":
    main()
