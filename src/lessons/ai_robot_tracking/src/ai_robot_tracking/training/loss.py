"""Assigns cells to boxes, and computes the loss.

Cells within a box are ranked by the root of their class score times the sixth power of their
overlap; the ten best are assigned to it, with target scores by the quality of their boxes.
"""

from __future__ import annotations

import torch
from torch.nn import functional
from torchvision.ops import box_iou, complete_box_iou_loss

ANSWERING = 10  # cells assigned to one box
SCORE_POWER, OVERLAP_POWER = 0.5, 6.0
SMALLEST_REACH = 5.0  # px: cells this near to a box's centre can be assigned to it, however small
BOX_WEIGHT, CLASS_WEIGHT = 5.0, 1.0
TINY = 1e-9


def detection_loss(
    boxes: torch.Tensor, logits: torch.Tensor, centres: torch.Tensor, truth: torch.Tensor
) -> torch.Tensor:
    """Mean loss of a batch.

    boxes (b, n, 4), logits (b, n, c), centres (n, 2) px; truth (b, m, 6): class, left, top, right,
    bottom, counts; unused rows have class -1.
    """
    wanted = (truth[..., 0] >= 0) & (truth[..., 5] > 0)
    near = _near(centres, truth[..., 1:5])
    owner, quality = _assign(boxes.detach(), logits.detach(), near & wanted[..., None], truth)
    answers = owner >= 0
    target = torch.zeros_like(logits)
    label = truth[..., 0].clamp(min=0).long().gather(1, owner.clamp(min=0))
    target.scatter_(2, label[..., None], (quality * answers)[..., None])
    # Barely visible objects count neither as missed nor as false detections.
    hardly = (near & ((truth[..., 0] >= 0) & (truth[..., 5] == 0))[..., None]).any(1)
    weight = (answers | ~hardly).float()
    cost = functional.binary_cross_entropy_with_logits(logits, target, reduction="none").sum(2)
    total = target.sum().clamp(min=1.0)
    class_cost = (cost * weight).sum() / total
    if not answers.any():
        return CLASS_WEIGHT * class_cost
    true_boxes = truth[..., 1:5].gather(1, owner.clamp(min=0)[..., None].expand(-1, -1, 4))
    off = complete_box_iou_loss(boxes[answers], true_boxes[answers])
    box_cost = (off * quality[answers]).sum() / total
    return BOX_WEIGHT * box_cost + CLASS_WEIGHT * class_cost


def _near(centres: torch.Tensor, boxes: torch.Tensor) -> torch.Tensor:
    """(b, m, n): whether a cell's centre is in a box, or very near to the box's centre."""
    x, y = centres[:, 0], centres[:, 1]
    middle = (boxes[..., :2] + boxes[..., 2:]) / 2
    reach = ((boxes[..., 2:] - boxes[..., :2]) / 2).clamp(min=SMALLEST_REACH)
    return ((x - middle[..., :1]).abs() < reach[..., :1]) & (
        (y - middle[..., 1:]).abs() < reach[..., 1:])


def _assign(
    boxes: torch.Tensor, logits: torch.Tensor, near: torch.Tensor, truth: torch.Tensor
) -> tuple[torch.Tensor, torch.Tensor]:
    """(b, n) index of the box that a cell is assigned to, -1: none; and its target score."""
    overlap = torch.stack(list(map(box_iou, truth[..., 1:5], boxes))) * near
    label = truth[..., 0].clamp(min=0).long()
    scores = logits.sigmoid().transpose(1, 2).gather(
        1, label[..., None].expand(-1, -1, boxes.shape[1]))
    merit = scores**SCORE_POWER * overlap**OVERLAP_POWER * near + TINY * near
    best = merit.topk(ANSWERING, dim=2)
    chosen = torch.zeros_like(merit).scatter_(2, best.indices, best.values) > 0
    # A cell claimed by several boxes is assigned to the one that it overlaps most.
    claim = torch.where(chosen, overlap, torch.full_like(overlap, -1.0))
    most, owner = claim.max(1)
    owner = torch.where(most >= 0, owner, torch.full_like(owner, -1))
    merit = merit * chosen
    peak = merit.amax(2, keepdim=True).clamp(min=TINY)
    sure = merit / peak * (overlap * chosen).amax(2, keepdim=True)
    return owner, sure.gather(1, owner.clamp(min=0)[:, None]).squeeze(1)
