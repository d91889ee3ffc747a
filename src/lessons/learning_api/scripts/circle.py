"""A module for 09import.py to import.  供 09import.py 导入的模块。"""

import math


def area(radius: float) -> float:
    """Area in m^2 of a circle with this radius in m.  圆的面积。"""
    return math.pi * radius**2
