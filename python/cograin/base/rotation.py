"""Finite rotations: rotation vectors \\[rad\\] in global axes, and quaternions (scalar first)."""

from __future__ import annotations

from math import atan2, cos, pi, sin, sqrt

import numpy as np

from cograin.base.vector import Matrix, Vector


def quaternion(rotation: Vector) -> Vector:
    """The unit quaternion of a rotation vector."""
    angle = sqrt(float(rotation @ rotation))
    found: Vector = np.concatenate([[cos(0.5 * angle)], (0.5 * _sine(0.5 * angle)) * rotation])
    return found


def after(second: Vector, first: Vector) -> Vector:
    """The quaternion of a rotation after another one."""
    one, other = first[1:], second[1:]
    scalar = second[0] * first[0] - float(other @ one)
    found: Vector = np.concatenate([[scalar], second[0] * one + first[0] * other + _cross(other, one)])
    return found


def back(attitude: Vector) -> Vector:
    """The quaternion of the opposite rotation."""
    found: Vector = attitude * np.array([1.0, -1.0, -1.0, -1.0])
    return found


def rotation_vector(attitude: Vector, near: Vector | None = None) -> Vector:
    """The rotation vector of a quaternion: that of at most half a turn, or the one that is nearest to a given one."""
    attitude = attitude if attitude[0] >= 0.0 else -attitude
    half = attitude[1:]
    length = sqrt(float(half @ half))
    if length == 0.0:
        return np.zeros(3) if near is None else _whole_turns(near)
    angle, axis = 2.0 * atan2(length, float(attitude[0])), half / length
    if near is not None:
        angle += 2.0 * pi * round((float(near @ axis) - angle) / (2.0 * pi))
    return axis * angle


def turn(before: Vector, now: Vector) -> Vector:
    """The rotation vector that leads from the attitude of one rotation vector to that of another."""
    return rotation_vector(after(quaternion(now), back(quaternion(before))))


def turned(attitude: Vector, arm: Vector) -> Vector:
    """A vector that turns with a body, in global axes."""
    axis = attitude[1:]
    twice = 2.0 * _cross(axis, arm)
    found: Vector = arm + attitude[0] * twice + _cross(axis, twice)
    return found


def matrix(attitude: Vector) -> Matrix:
    """The rotation matrix of a quaternion."""
    w, x, y, z = attitude.tolist()
    return np.array(
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
            [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
        ]
    )


def cross(left: Vector) -> Matrix:
    """The matrix that takes a vector to left × vector."""
    x, y, z = left
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def tangent(rotation: Vector) -> Matrix:
    """How far a body turns, in global axes, for each change of its rotation vector.

    It also takes a vector to its mean while it turns at a constant rate through this rotation.
    """
    angle = sqrt(float(rotation @ rotation))
    spin, half = cross(rotation), _sine(0.5 * angle)
    found: Matrix = np.eye(3) + 0.5 * half * half * spin + _third(angle) * (spin @ spin)
    return found


def secant(before: Vector, now: Vector) -> Matrix:
    """The same over a finite change of the rotation vector: the matrix takes this change to the `turn`, to rounding."""
    change = now - before
    middle = tangent(before + 0.5 * change)
    square = float(change @ change)
    if square == 0.0:
        return middle
    found: Matrix = middle + np.outer(turn(before, now) - middle @ change, change) / square
    return found


def _cross(left: Vector, right: Vector) -> Vector:
    """Cross product, without what numpy looks at before."""
    a, b, c = left.tolist()
    x, y, z = right.tolist()
    return np.array([b * z - c * y, c * x - a * z, a * y - b * x])


def _sine(angle: float) -> float:
    """sin x / x."""
    return sin(angle) / angle if angle else 1.0


def _third(angle: float) -> float:
    """(x − sin x)/x³."""
    if abs(angle) > 1.0:
        return (angle - sin(angle)) / angle**3
    # The difference would lose digits.
    square, found = angle * angle, 1.0
    for divisor in (272.0, 210.0, 156.0, 110.0, 72.0, 42.0, 20.0):
        found = 1.0 - square / divisor * found
    return found / 6.0


def _whole_turns(near: Vector) -> Vector:
    """The whole turns that are nearest to a rotation vector, about its axis."""
    length = sqrt(float(near @ near))
    turns = round(length / (2.0 * pi))
    return near * (2.0 * pi * turns / length) if turns else np.zeros(3)
