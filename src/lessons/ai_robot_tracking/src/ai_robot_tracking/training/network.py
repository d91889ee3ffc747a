"""The network, from torchvision's blocks: images in, boxes and class logits of every cell out.

Strides 8, 16 and 32, each with a head; features go down, up and down again. About 0.3 GMAC for an
input of 320 x 256.
"""

from __future__ import annotations

from functools import cache, partial

import torch
from torch import nn
from torch.nn import functional
from torchvision.ops import Conv2dNormActivation

from ai_robot_tracking.training import CLASSES

STRIDES = (8, 16, 32)
POOL_SIDE = 5
RARE = -4.6  # logit of 1 %: few detections at the start, which keeps training stable
_NORM = partial(nn.BatchNorm2d, momentum=0.03, eps=1e-3)


def _conv(inner: int, outer: int, side: int = 3, stride: int = 1) -> nn.Sequential:
    """Convolution, batch norm, ReLU."""
    return Conv2dNormActivation(inner, outer, side, stride, norm_layer=_NORM)


class _Residual(nn.Sequential):
    """Two convolutions through half as many channels, added to the input."""

    def __init__(self, channels: int):
        super().__init__(_conv(channels, channels // 2), _conv(channels // 2, channels))

    def forward(self, features: torch.Tensor) -> torch.Tensor:
        return features + super().forward(features)


class _Pools(nn.Module):
    """Max pooling at three sizes, so that a cell has the context of a whole large object."""

    def __init__(self, inner: int, outer: int):
        super().__init__()
        self.first, self.last = _conv(inner, outer, 1), _conv(3 * outer, outer, 1)

    def forward(self, features: torch.Tensor) -> torch.Tensor:
        sizes = [self.first(features)]
        for _ in range(2):
            sizes.append(functional.max_pool2d(sizes[-1], POOL_SIDE, 1, POOL_SIDE // 2))
        return self.last(torch.cat(sizes, 1))


class Detector(nn.Module):
    """`forward` returns boxes (b, n, 4) and logits (b, n, classes).

    Boxes are left, top, right, bottom in px of the input. n counts the cells of all strides, the
    finest first, row by row.
    """

    def __init__(self) -> None:
        super().__init__()
        self.down8 = nn.Sequential(_conv(3, 16, stride=2), _conv(16, 32, stride=2),
                                   _conv(32, 64, stride=2), _Residual(64))
        self.down16 = nn.Sequential(_conv(64, 96, stride=2), _Residual(96))
        self.down32 = nn.Sequential(_conv(96, 128, stride=2), _Residual(128), _Pools(128, 64))
        self.up16 = nn.Sequential(_conv(64 + 96, 64, 1), _conv(64, 64))
        self.up8 = nn.Sequential(_conv(64 + 64, 48, 1), _conv(48, 48))
        self.again16, self.out16 = _conv(48, 48, stride=2), _conv(48 + 64, 64, 1)
        self.again32, self.out32 = _conv(64, 64, stride=2), _conv(64 + 64, 80, 1)
        widths = (48, 64, 64)
        self.inner = nn.ModuleList(map(_conv, (48, 64, 80), widths))
        self.boxes = nn.ModuleList(nn.Conv2d(width, 4, 1) for width in widths)
        self.classes = nn.ModuleList(nn.Conv2d(width, len(CLASSES), 1) for width in widths)
        for part in self.modules():
            if isinstance(part, nn.Conv2d) and part.bias is None:
                nn.init.kaiming_normal_(part.weight, mode="fan_out", nonlinearity="relu")
        for heads, bias in ((self.boxes, 1.0), (self.classes, RARE)):
            for head in heads:
                nn.init.constant_(head.bias, bias)
                nn.init.normal_(head.weight, std=0.01)

    def forward(self, images: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
        level8 = self.down8(images)
        level16 = self.down16(level8)
        top = self.down32(level16)
        middle = self.up16(torch.cat([_doubled(top), level16], 1))
        fine = self.up8(torch.cat([_doubled(middle), level8], 1))
        middle = self.out16(torch.cat([self.again16(fine), middle], 1))
        coarse = self.out32(torch.cat([self.again32(middle), top], 1))
        boxes, logits = [], []
        for features, inner, box, kind in zip((fine, middle, coarse), self.inner, self.boxes,
                                              self.classes):
            features = inner(features)
            boxes.append(functional.softplus(box(features)).flatten(2).transpose(1, 2))
            logits.append(kind(features).flatten(2).transpose(1, 2))
        centres, strides = cells(*images.shape[2:])
        reach = torch.cat(boxes, 1) * strides
        return (torch.cat([centres - reach[..., :2], centres + reach[..., 2:]], 2),
                torch.cat(logits, 1))


def _doubled(features: torch.Tensor) -> torch.Tensor:
    return functional.interpolate(features, scale_factor=2.0, mode="nearest")


@cache  # also so that an exported network has them as constants
def cells(height: int, width: int) -> tuple[torch.Tensor, torch.Tensor]:
    """Of all cells of an input: (n, 2) centres, x and y in px, and (n, 1) strides."""
    centres, strides = [], []
    for stride in STRIDES:
        y, x = torch.meshgrid(torch.arange(height // stride), torch.arange(width // stride),
                              indexing="ij")
        centres.append((torch.stack([x, y], -1).reshape(-1, 2) + 0.5) * stride)
        strides.append(torch.full((len(centres[-1]), 1), float(stride)))
    return torch.cat(centres), torch.cat(strides)
