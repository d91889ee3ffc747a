"""The network as a list of layers, from which the torch module and the ONNX file are made.

Strides 8, 16 and 32, each with a head; features go down, up and down again. About 0.3 GMAC for an
input of 320 x 256.
"""

from __future__ import annotations

from dataclasses import dataclass

from ai_robot_tracking.training import CLASSES

STRIDES = (8, 16, 32)
CONV, HEAD, ADD, CONCAT, DOUBLE, POOL = "conv", "head", "add", "concat", "double", "pool"
POOL_SIDE = 5


@dataclass(frozen=True)
class Layer:
    """One step: its name, its kind, and the names of its inputs."""

    name: str
    kind: str  # CONV: convolution, batch norm, ReLU; HEAD: a plain 1 x 1 convolution with bias
    inputs: tuple[str, ...]
    channels: int  # of the output
    side: int = 1  # of the kernel
    stride: int = 1


class _Builder:
    """Collects layers and knows how many channels each has."""

    def __init__(self) -> None:
        self.layers: list[Layer] = []
        self._channels = {"image": 3}

    def add(self, name: str, kind: str, inputs: tuple[str, ...], channels: int = 0,
            side: int = 1, stride: int = 1) -> str:
        widths = [self._channels[source] for source in inputs]
        channels = channels or (sum(widths) if kind == CONCAT else widths[0])
        self._channels[name] = channels
        self.layers.append(Layer(name, kind, inputs, channels, side, stride))
        return name

    def conv(self, name: str, source: str, channels: int, side: int = 3, stride: int = 1) -> str:
        return self.add(name, CONV, (source,), channels, side, stride)

    def residual(self, name: str, source: str) -> str:
        """Two convolutions through half as many channels, added to the input."""
        inner = self.conv(f"{name}.in", source, self._channels[source] // 2)
        outer = self.conv(f"{name}.out", inner, self._channels[source])
        return self.add(name, ADD, (source, outer))

    def merged(self, name: str, first: str, second: str, channels: int) -> str:
        joined = self.add(f"{name}.join", CONCAT, (first, second))
        return self.conv(f"{name}.mix", joined, channels, side=1)


def network_layers() -> list[Layer]:
    """All layers in order; the heads are `box8`, `class8`, `box16` and so on."""
    build = _Builder()
    half = build.conv("stem", "image", 16, stride=2)
    quarter = build.conv("down4", half, 32, stride=2)
    level8 = build.residual("body8", build.conv("down8", quarter, 64, stride=2))
    level16 = build.residual("body16", build.conv("down16", level8, 96, stride=2))
    level32 = build.residual("body32", build.conv("down32", level16, 128, stride=2))
    top = _pyramid_of_pools(build, level32)
    middle = build.merged("up16", build.add("double32", DOUBLE, (top,)), level16, 64)
    middle = build.conv("mid16", middle, 64)
    fine = build.merged("up8", build.add("double16", DOUBLE, (middle,)), level8, 48)
    fine = build.conv("mid8", fine, 48)
    middle = build.merged("out16", build.conv("again16", fine, 48, stride=2), middle, 64)
    coarse = build.merged("out32", build.conv("again32", middle, 64, stride=2), top, 80)
    for stride, source, width in zip(STRIDES, (fine, middle, coarse), (48, 64, 64)):
        inner = build.conv(f"inner{stride}", source, width)
        build.add(f"box{stride}", HEAD, (inner,), 4)
        build.add(f"class{stride}", HEAD, (inner,), len(CLASSES))
    return build.layers


def _pyramid_of_pools(build: _Builder, source: str) -> str:
    """Max pooling at three sizes, so that a cell has the context of a whole large object."""
    small = build.conv("pools.in", source, 64, side=1)
    pooled = build.add("pools.1", POOL, (small,))
    twice = build.add("pools.2", POOL, (pooled,))
    joined = build.add("pools.join", CONCAT, (small, pooled, twice))
    return build.conv("pools.out", joined, 64, side=1)
