"""Velocities of rigid bodies, and their values at other points and in other frames."""

from dataclasses import dataclass

from bullet_sim.pose import Pose, Vector3, conjugate, rotate


@dataclass(frozen=True)
class Twist:
    """Velocity of a frame's origin and its angular velocity, both in world axes."""

    linear: Vector3 = (0.0, 0.0, 0.0)  # m/s
    angular: Vector3 = (0.0, 0.0, 0.0)  # rad/s


STILL = Twist()


def dot(a, b) -> float:
    """Scalar product."""
    return sum(x * y for x, y in zip(a, b, strict=True))


def add(a, b) -> Vector3:
    """The sum of two vectors."""
    return tuple(x + y for x, y in zip(a, b, strict=True))


def negative(vector) -> Vector3:
    """The opposite vector."""
    return tuple(-x for x in vector)


def cross(a, b) -> Vector3:
    """Vector product."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def shifted_twist(twist: Twist, at: Vector3, to: Vector3) -> Twist:
    """The same rigid motion, at another point."""
    ax, ay, az = twist.angular
    x, y, z = (t - a for t, a in zip(to, at, strict=True))
    linear = twist.linear
    return Twist(
        (linear[0] + ay * z - az * y, linear[1] + az * x - ax * z, linear[2] + ax * y - ay * x),
        twist.angular,
    )


def twist_difference(a: Twist, b: Twist) -> Twist:
    """`a` minus `b`."""
    return Twist(tuple(x - y for x, y in zip(a.linear, b.linear, strict=True)),
                 tuple(x - y for x, y in zip(a.angular, b.angular, strict=True)))


def twist_in(pose: Pose, twist: Twist) -> Twist:
    """A world-axes twist, rotated into the axes of `pose`."""
    back = conjugate(pose.orientation)
    return Twist(rotate(back, twist.linear), rotate(back, twist.angular))
