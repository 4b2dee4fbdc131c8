"""Finds the parameter of a compressor that gives an error or a size which it cannot be asked for."""

import math

MOST_STEPS = 12


def smallest_that_reaches(measure, target, start, slope, grain, tolerance, most_steps=MOST_STEPS):
    """Returns the measurement of the lowest quality that still has value >= target; None if no step has.

    `measure(x)` -> (value, measurement); value grows with x, at first guess by `slope` for each unit of x. x is a
    multiple of `grain`. Ends where value is at most `tolerance` above target, at neighbours, or after `most_steps`.
    """
    below = above = None  # (x, value, measurement) on each side of the target, the nearest ones
    x, tried = _snap(start, grain), set()
    for _ in range(most_steps):
        tried.add(x)
        value, measurement = measure(x)
        if value < target:
            below = (x, value, measurement) if below is None or x > below[0] else below
        else:
            above = (x, value, measurement) if above is None or x < above[0] else above
            if value - target <= tolerance:
                break
        x = _next(below, above, target + tolerance / 2, slope, grain)
        if x in tried:
            break
    return above[2] if above else None


def _next(below, above, aim, slope, grain):
    if below and above:
        if not math.isfinite(above[1]) or not math.isfinite(below[1]):
            share = 0.5
        else:
            share = min(0.9, max(0.1, (aim - below[1]) / (above[1] - below[1])))
        x = _snap(below[0] + share * (above[0] - below[0]), grain)
        return x if below[0] < x < above[0] else _snap((below[0] + above[0]) / 2, grain)
    x, value, _ = below or above
    distance = (aim - value) / slope if math.isfinite(value) else -20 * grain
    step = max(grain, abs(distance)) * (1 if below else -1)
    return _snap(x + step, grain)


def _snap(x, grain):
    return round(x / grain) * grain
