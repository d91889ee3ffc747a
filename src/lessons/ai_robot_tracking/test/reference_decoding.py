"""YOLO decoding written out step by step from its published layouts, slowly, to compare with.

v5: one row for each candidate, x, y, w, h, objectness, then a score for each class.
v8: one column for each candidate, x, y, w, h, then a score for each class.
"""


def reference_boxes(output, layout, confidence, iou, picture, network):
    """[(left, top, right, bottom, score, class)] in px of the picture, surest first.

    `picture` and `network` are (height, width) in px of the picture and of the network's input.
    """
    candidates = []
    count = len(output[0]) if layout == "v5" else len(output[0][0])
    for index in range(count):
        if layout == "v5":
            row = [float(value) for value in output[0][index]]
            x, y, w, h = row[:4]
            scores = [score * row[4] for score in row[5:]]
        else:
            column = [float(line[index]) for line in output[0]]
            x, y, w, h = column[:4]
            scores = column[4:]
        if any(value != value or abs(value) == float("inf") for value in [x, y, w, h, *scores]):
            continue
        if w <= 0 or h <= 0:
            continue
        label = 0
        for number in range(len(scores)):
            if scores[number] > scores[label]:
                label = number
        if scores[label] > confidence:
            box = (x - w / 2, y - h / 2, x + w / 2, y + h / 2)
            candidates.append((box, scores[label], label))
    candidates.sort(key=lambda candidate: -candidate[1])
    kept = []
    for box, score, label in candidates:
        if all(label != other or shared(box, taken) <= iou for taken, _, other in kept):
            kept.append((box, score, label))
    return [(*in_picture(box, picture, network), score, label) for box, score, label in kept]


def shared(a, b):
    """Intersection over union."""
    width = min(a[2], b[2]) - max(a[0], b[0])
    height = min(a[3], b[3]) - max(a[1], b[1])
    if width <= 0 or height <= 0:
        return 0.0
    common = width * height
    return common / ((a[2] - a[0]) * (a[3] - a[1]) + (b[2] - b[0]) * (b[3] - b[1]) - common)


def in_picture(box, picture, network):
    """Undoes the letterbox: one scale, grey half on each side; then cut to the picture."""
    scale = min(network[0] / picture[0], network[1] / picture[1])
    beside = (network[1] - round(picture[1] * scale)) // 2
    above = (network[0] - round(picture[0] * scale)) // 2
    left, top, right, bottom = box
    x = [min(max((side - beside) / scale, 0), picture[1]) for side in (left, right)]
    y = [min(max((side - above) / scale, 0), picture[0]) for side in (top, bottom)]
    return x[0], y[0], x[1], y[1]
