#!/usr/bin/env python3
"""Takes the picture of the page that the READMEs show: no test.

    roslaunch learning_topic 0course.launch gui:=false
    roslaunch sim_viewer viewer.launch control:=true
    python3 src/sim/sim_viewer/test/page_picture.py [--out FILE]

The page must run with control; its address comes from the parameter /sim_viewer/url.
"""

import argparse
import time
from pathlib import Path

import cv2
import rosgraph
from chromium import Browser

OUT = Path(__file__).resolve().parents[1] / "images" / "page.png"
SIZE_PX = (1280, 640)
DRIVEN = 1.5  # s, so that the robot has left its start
DRAWN = 3.0  # s, in which a processor has drawn what stands in the 3D view


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=OUT)
    out = parser.parse_args().out
    browser = Browser()
    try:
        page = browser.open(rosgraph.Master("/page_picture").getParam("/sim_viewer/url") + "#drive")
        page.resize(*SIZE_PX)
        page.wait_for("document.querySelector('#drive-topic')?.value == '/cmd_vel'")
        page.wait_for("document.querySelectorAll('.views option').length > 1")
        time.sleep(DRAWN)
        page.key("w", True)
        page.wait_for("document.querySelector('#drive-state').dataset.state == 'driving'")
        time.sleep(DRIVEN)
        cv2.imwrite(str(out), page.picture(), [cv2.IMWRITE_PNG_COMPRESSION, 9])
        page.key("w", False)
    finally:
        browser.close()
    print(out)


if __name__ == "__main__":
    main()
