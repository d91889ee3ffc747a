"""Circles; 09import.py imports this.  供 09import.py 导入的模块。"""

import math


def area(radius: float) -> float:
    """Area in m2 of a circle of that radius in m.  圆的面积。"""
    return math.pi * radius**2
