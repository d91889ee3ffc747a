"""The network in torch: images in, boxes and class logits of every cell out."""

from __future__ import annotations

import torch
from torch import nn
from torch.nn import functional

from ai_robot_tracking.training.layers import (
    ADD,
    CONCAT,
    CONV,
    DOUBLE,
    HEAD,
    POOL,
    POOL_SIDE,
    STRIDES,
    Layer,
    network_layers,
)

RARE = -4.6  # logit of 1 %: few detections at the start, which keeps training stable


class Detector(nn.Module):
    """Layers from `network_layers`; `forward` returns boxes (b, n, 4), logits (b, n, classes).

    Boxes are left, top, right, bottom in px of the input. n counts the cells of all strides, the
    finest first, row by row.
    """

    def __init__(self) -> None:
        super().__init__()
        self.layers = network_layers()
        self.parts = nn.ModuleDict()
        widths = {"image": 3}
        for layer in self.layers:
            widths[layer.name] = layer.channels
            if layer.kind in (CONV, HEAD):
                self.parts[_key(layer.name)] = _part(layer, widths[layer.inputs[0]])

    def forward(self, images: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
        found = {"image": images}
        for layer in self.layers:
            found[layer.name] = self._run(layer, [found[name] for name in layer.inputs])
        boxes, logits = [], []
        for stride in STRIDES:
            raw = found[f"box{stride}"]
            centres = cell_centres(raw.shape[2], raw.shape[3], stride, raw.device)
            reach = functional.softplus(raw).flatten(2).transpose(1, 2) * stride
            boxes.append(torch.cat([centres - reach[..., :2], centres + reach[..., 2:]], 2))
            logits.append(found[f"class{stride}"].flatten(2).transpose(1, 2))
        return torch.cat(boxes, 1), torch.cat(logits, 1)

    def _run(self, layer: Layer, sources: list[torch.Tensor]) -> torch.Tensor:
        if layer.kind == ADD:
            return sources[0] + sources[1]
        if layer.kind == CONCAT:
            return torch.cat(sources, 1)
        if layer.kind == DOUBLE:
            return functional.interpolate(sources[0], scale_factor=2, mode="nearest")
        if layer.kind == POOL:
            return functional.max_pool2d(sources[0], POOL_SIDE, 1, POOL_SIDE // 2)
        return self.parts[_key(layer.name)](sources[0])

    def convolution(self, layer: Layer) -> tuple[torch.Tensor, torch.Tensor]:
        """Weights and bias of a CONV or HEAD layer, with batch norm folded in."""
        part = self.parts[_key(layer.name)]
        if layer.kind == HEAD:
            return part.weight.detach(), part.bias.detach()
        conv, norm = part[0], part[1]
        gain = norm.weight / torch.sqrt(norm.running_var + norm.eps)
        weight = conv.weight * gain[:, None, None, None]
        return weight.detach(), (norm.bias - norm.running_mean * gain).detach()


def cell_centres(rows: int, columns: int, stride: int, device=None) -> torch.Tensor:
    """(rows * columns, 2) x and y of the cells' centres, px of the input."""
    y, x = torch.meshgrid(torch.arange(rows, device=device), torch.arange(columns, device=device),
                          indexing="ij")
    return (torch.stack([x, y], -1).reshape(-1, 2) + 0.5) * stride


def _part(layer: Layer, width: int) -> nn.Module:
    if layer.kind == HEAD:
        head = nn.Conv2d(width, layer.channels, 1)
        nn.init.constant_(head.bias, RARE if layer.name.startswith("class") else 1.0)
        nn.init.normal_(head.weight, std=0.01)
        return head
    conv = nn.Conv2d(width, layer.channels, layer.side, layer.stride, layer.side // 2, bias=False)
    nn.init.kaiming_normal_(conv.weight, mode="fan_out", nonlinearity="relu")
    return nn.Sequential(conv, nn.BatchNorm2d(layer.channels, momentum=0.03, eps=1e-3),
                         nn.ReLU(inplace=True))


def _key(name: str) -> str:
    return name.replace(".", "_")  # torch allows no dot in a name
