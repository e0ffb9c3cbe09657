"""Paints assets/tex/*.png: MIMo's face and hair, eyes, clothes, and the rug.

    python make_textures.py [--out DIR]

Everything is a function of the direction from the middle of the thing painted, evaluated at the pixels of the sides of
a cube map, so that sides meet without a seam. The face is drawn in degrees: u to MIMo's left, v up, both 0 straight
ahead, distances true along lines through that point. Nothing is random: the same files come out each time.
"""

import argparse
from pathlib import Path

import numpy as np
from PIL import Image

# Colours that meet materials of assets/babybench/meta_common.xml are those of the material.
SKIN = (242, 204, 128)
SKIN_SHADE = (219, 170, 97)
GREEN, GREEN_CUFF, GREEN_SEAM = (26, 128, 0), (72, 156, 48), (14, 98, 0)
BLUE, BLUE_CUFF, BLUE_SEAM = (26, 26, 153), (70, 74, 184), (16, 16, 118)
HAIR, HAIR_DARK, HAIR_LIGHT = (150, 96, 58), (122, 74, 42), (176, 120, 76)
BROW = (128, 82, 50)
LINE = (126, 62, 48)
LASH = (96, 58, 40)
BLUSH = (240, 140, 112)
MOUTH, TONGUE, TOOTH = (132, 44, 46), (232, 122, 116), (252, 248, 238)
TEAR = (150, 205, 240)
IRIS, IRIS_DARK, IRIS_LIGHT = (112, 72, 40), (64, 38, 22), (168, 118, 66)

# Where the eyeballs come out of the head, in degrees; they reach 6.2 degrees from there, the painted lids a bit more.
EYE_U, EYE_V, LID_R = 21.8, -5.5, 7.1


# ---- cube maps

def directions(side, size):
    """Unit vectors through the pixels of one side of a cube map, shape (size, size, 3)."""
    c = (2 * np.arange(size) + 1) / size - 1
    s, t = np.meshgrid(c, c)
    one = np.ones_like(s)
    d = {
        "right": (one, -t, -s), "left": (-one, -t, s), "up": (s, one, t),
        "down": (s, -one, -t), "front": (s, -t, one), "back": (-s, -t, -one),
    }[side]
    d = np.stack(d, -1)
    return d / np.linalg.norm(d, axis=-1, keepdims=True)


def save(path, rgb, colours=96):
    image = Image.fromarray(np.clip(np.round(rgb), 0, 255).astype(np.uint8), "RGB")
    image = image.quantize(colours, Image.Quantize.MEDIANCUT, kmeans=3, dither=Image.Dither.NONE)
    image.save(path, optimize=True)


# ---- painting

def fill(rgb, colour, cover):
    """Lays `colour` over `rgb` where `cover` is 1, mixing in between."""
    cover = np.clip(cover, 0, 1)[..., None]
    return rgb * (1 - cover) + np.asarray(colour, float) * cover


def inside(distance, soft=0.22):
    """Cover of a shape from the signed distance to its border, negative inside."""
    return np.clip(0.5 - distance / soft, 0, 1)


def smooth(x, low, high):
    x = np.clip((x - low) / (high - low), 0, 1)
    return x * x * (3 - 2 * x)


def bell(u, v, at, width):
    return np.exp(-0.5 * (((u - at[0]) / width[0]) ** 2 + ((v - at[1]) / width[1]) ** 2))


def ellipse(u, v, at, radii):
    """Distance to an ellipse, good near its border."""
    q = np.hypot((u - at[0]) / radii[0], (v - at[1]) / radii[1])
    return (q - 1) * min(radii)


def curve(points, n=28):
    """A Catmull-Rom curve through `points`."""
    p = np.asarray(points, float)
    p = np.vstack([2 * p[0] - p[1], p, 2 * p[-1] - p[-2]])
    t = np.linspace(0, 1, n, endpoint=False)[:, None]
    parts = []
    for a, b, c, d in zip(p, p[1:], p[2:], p[3:]):
        parts.append(0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t**2 + (3 * b - a - 3 * c + d) * t**3))
    return np.vstack([*parts, p[-2]])


def stroke(u, v, points, width, taper=0.5):
    """Distance to a brush stroke along a curve; its half width goes from `width` in the middle to `taper` times that."""
    c = curve(points)
    far = np.full(u.shape, 99.0)
    low, high = c.min(0) - width - 1, c.max(0) + width + 1
    near = (u > low[0]) & (u < high[0]) & (v > low[1]) & (v < high[1])
    if not near.any():
        return far
    x, y = u[near], v[near]
    best = np.full(x.shape, 99.0)
    along = np.linspace(-1, 1, len(c))
    for (a, b), s in zip(zip(c, c[1:]), along):
        e = b - a
        t = np.clip(((x - a[0]) * e[0] + (y - a[1]) * e[1]) / max(e @ e, 1e-12), 0, 1)
        w = width * (taper + (1 - taper) * np.sqrt(1 - s * s))
        best = np.minimum(best, np.hypot(x - a[0] - t * e[0], y - a[1] - t * e[1]) - w)
    far[near] = best
    return far


def blob(u, v, points):
    """Signed distance to the area inside a closed curve through `points`."""
    c = curve([*points, points[0]])
    distance, odd = np.full(u.shape, 99.0), np.zeros(u.shape, bool)
    for a, b in zip(c, np.roll(c, -1, 0)):
        e = b - a
        if e @ e < 1e-12:
            continue
        t = np.clip(((u - a[0]) * e[0] + (v - a[1]) * e[1]) / (e @ e), 0, 1)
        distance = np.minimum(distance, np.hypot(u - a[0] - t * e[0], v - a[1] - t * e[1]))
        if a[1] != b[1]:
            odd ^= ((a[1] > v) != (b[1] > v)) & (u < (b[0] - a[0]) * (v - a[1]) / (b[1] - a[1]) + a[0])
    return np.where(odd, -distance, distance)


# ---- the head

# Points from the outer to the inner end of the right brow (u, v) and its half width; the left one mirrors it.
BROWS = {
    "default": ([(-28.5, 4.4), (-25, 6.4), (-21, 7.2), (-16, 6.6)], 0.95),
    "happy": ([(-28.5, 5.6), (-22.5, 9.0), (-16, 7.4)], 0.95),
    "sad": ([(-28.5, 3.4), (-22.5, 6.4), (-16, 9.8)], 0.95),
    "surprised": ([(-28.5, 8.6), (-22.5, 12.0), (-16, 10.6)], 0.95),
    "angry": ([(-28.5, 8.2), (-22, 6.0), (-14.5, 2.4)], 1.25),
    "disgusted": ([(-28.5, 5.4), (-22, 4.9), (-15, 2.9)], 1.1),
    "scared": ([(-28.5, 5.2), (-22.5, 9.2), (-15.5, 12.6)], 0.9),
}
BLUSHES = {"default": 0.42, "happy": 0.62, "angry": 0.75, "scared": 0.12, "disgusted": 0.2, "surprised": 0.4, "sad": 0.4}


def hairline(azimuth):
    """Elevation of the lower border of the hair against the azimuth (0 ahead, 180 behind), both in degrees."""
    a = np.abs(azimuth)
    line = np.interp(a, [0, 18, 36, 52, 64, 74, 83, 92, 104, 130, 180], [34, 33, 29, 23, 15, 3, 0, 3, -16, -30, -33])
    # Locks: teeth that lean to one side, longer in front.
    lock = (azimuth + 7) / 15.0
    lock = lock - np.floor(lock)
    tooth = np.where(lock < 0.72, lock / 0.72, (1 - lock) / 0.28)
    return line - (3.4 * smooth(-a, -60, -46) + 1.2 * smooth(a, 104, 120)) * (tooth**1.5 - 0.4)


def paint_hair(rgb, d):
    azimuth = np.degrees(np.arctan2(d[..., 1], d[..., 0]))
    elevation = np.degrees(np.arcsin(np.clip(d[..., 2], -1, 1)))
    # Strands run away from a whorl on the back of the crown.
    whorl = np.array([-0.5, 0.12, 0.857])
    whorl /= np.linalg.norm(whorl)
    across = np.cross(whorl, [0.0, 1.0, 0.0])
    across /= np.linalg.norm(across)
    along = np.cross(whorl, across)
    reach = np.degrees(np.arccos(np.clip(d @ whorl, -1, 1)))
    turn = np.arctan2(d @ along, d @ across) + 0.011 * reach
    strand = 0.7 * np.sin(23 * turn + 0.6 * np.sin(7 * turn)) + 0.7 * np.sin(41 * turn + 1.3) + 0.4 * np.sin(67 * turn)
    strength = smooth(reach, 3, 45) * 0.36
    hair = fill(np.broadcast_to(np.asarray(HAIR, float), d.shape), HAIR_LIGHT, strength * np.clip(strand, 0, 1.6))
    hair = fill(hair, HAIR_DARK, strength * np.clip(-strand, 0, 1.6))
    over = elevation - hairline(azimuth)
    rgb = fill(rgb, SKIN_SHADE, 0.55 * smooth(over, -3.5, 0))
    hair = fill(hair, HAIR_DARK, 0.5 * (1 - smooth(over, 0, 2.5)))
    return mix(rgb, hair, inside(-over, 0.4))


def mix(below, above, cover):
    cover = np.clip(cover, 0, 1)[..., None]
    return below * (1 - cover) + above * cover


def paint_ears(rgb, d):
    for sign in (1, -1):
        # Local coordinates on the side of the head: x forward, y up.
        x = np.degrees(np.arctan2(d[..., 0], sign * d[..., 1]))
        y = np.degrees(np.arcsin(np.clip(d[..., 2], -1, 1)))
        here = sign * d[..., 1] > 0.3
        x, y = np.where(here, x, 90.0), np.where(here, y, 90.0)
        ear = np.minimum(ellipse(x, y, (-1, -5), (6.6, 8.4)), ellipse(x, y, (0.8, -12), (4.2, 4.6)))
        rgb = fill(rgb, SKIN_SHADE, 0.8 * inside(ear - 0.9, 0.9))
        rgb = fill(rgb, SKIN, inside(ear, 0.4))
        rgb = fill(rgb, BLUSH, 0.25 * inside(ear + 1.5, 3.0))
        rim = stroke(x, y, [(3.2, -1.5), (0.5, 0.6), (-3.6, -1.2), (-4.4, -6.0), (-2.2, -10.4)], 0.55)
        fold = stroke(x, y, [(1.2, -4.2), (-1.2, -4.6), (-1.4, -7.2), (0.8, -8.8)], 0.5)
        rgb = fill(rgb, (196, 140, 82), inside(np.minimum(rim, fold), 0.4))
    return rgb


def paint_eyelids(rgb, u, v):
    for sign in (1, -1):
        x, y = sign * (u - sign * EYE_U), v - EYE_V
        r = np.hypot(x, y)
        # The white reaches beyond the eyeball, up to the lids.
        rgb = fill(rgb, SKIN_SHADE, 0.5 * (1 - smooth(r, LID_R, LID_R + 3.0)))
        rgb = fill(rgb, (250, 248, 246), inside(r - LID_R, 0.3))
        lid = [(LID_R * np.cos(t), LID_R * np.sin(t)) for t in np.radians([0, 32, 64, 95, 126, 157, 176])]
        rgb = fill(rgb, LASH, inside(stroke(x, y, lid, 0.8, 0.4)))
        for t in (10, 25, 40):
            lash = [((LID_R + k) * np.cos(a), (LID_R + k) * np.sin(a)) for k, a in zip((0, 1, 2.1), np.radians([t, t - 3, t - 9]))]
            rgb = fill(rgb, LASH, inside(stroke(x, y, lash, 0.36, 0.6)))
        lower = [(LID_R * np.cos(t), LID_R * np.sin(t)) for t in np.radians([-25, -65, -115, -155])]
        rgb = fill(rgb, (190, 132, 84), 0.8 * inside(stroke(x, y, lower, 0.38, 0.4), 0.4))
    return rgb


def paint_nose(rgb, u, v):
    rgb = fill(rgb, BLUSH, 0.22 * bell(u, v, (0, -13.4), (3.0, 2.4)))
    rgb = fill(rgb, (252, 226, 168), 0.55 * bell(u, v, (0.6, -12.2), (1.2, 1.0)))
    rgb = fill(rgb, (196, 138, 78), inside(stroke(u, v, [(-2.7, -14.2), (-1.6, -15.9), (0, -16.3), (1.6, -15.9), (2.7, -14.2)], 0.5)))
    return rgb


def open_mouth(rgb, u, v, lips, tongue=None, teeth=()):
    """A mouth with its lip line, clipped to the mouth."""
    mouth = blob(u, v, lips)
    rgb = fill(rgb, LINE, inside(mouth - 0.7, 0.3))
    within = inside(mouth, 0.3)
    rgb = fill(rgb, MOUTH, within)
    if tongue:
        rgb = fill(rgb, TONGUE, within * inside(ellipse(u, v, *tongue), 0.5))
    for tooth in teeth:
        rgb = fill(rgb, TOOTH, within * inside(ellipse(u, v, *tooth), 0.3))
    return rgb


def line_mouth(rgb, u, v, points, width=0.75):
    return fill(rgb, LINE, inside(stroke(u, v, points, width, 0.45)))


def paint_mouth(rgb, u, v, mood):
    if mood == "default":
        rgb = line_mouth(rgb, u, v, [(-6.2, -23.2), (-3.4, -25.3), (0, -26.0), (3.4, -25.3), (6.2, -23.2)])
        for sign in (1, -1):
            rgb = line_mouth(rgb, u, v, [(sign * 5.6, -22.5), (sign * 6.6, -23.0), (sign * 7.0, -24.0)], 0.4)
        return fill(rgb, TONGUE, 0.45 * bell(u, v, (0, -28.0), (2.2, 0.8)))
    if mood == "happy":
        lips = [(-8.2, -21.4), (-4, -22.7), (0, -23.1), (4, -22.7), (8.2, -21.4), (6.8, -27.0), (3.4, -30.2), (0, -31.0), (-3.4, -30.2), (-6.8, -27.0)]
        return open_mouth(rgb, u, v, lips, ((0, -31.2), (4.6, 3.4)), [((-1.25, -23.4), (1.2, 1.9)), ((1.25, -23.4), (1.2, 1.9))])
    if mood == "sad":
        rgb = line_mouth(rgb, u, v, [(-5.6, -27.6), (-3, -25.3), (0, -24.6), (3, -25.3), (5.6, -27.6)])
        rgb = fill(rgb, TONGUE, 0.5 * bell(u, v, (0, -27.6), (2.4, 0.9)))
        for at in ((-24.5, -17.4), (25.5, -21.5)):
            drop = blob(u, v, [(at[0], at[1] + 3.0), (at[0] + 1.3, at[1]), (at[0], at[1] - 1.5), (at[0] - 1.3, at[1])])
            rgb = fill(rgb, (110, 170, 215), inside(drop - 0.25, 0.3))
            rgb = fill(rgb, TEAR, inside(drop + 0.2, 0.3))
            rgb = fill(rgb, (240, 250, 255), 0.9 * bell(u, v, (at[0] - 0.4, at[1] + 0.2), (0.4, 0.5)))
        return rgb
    if mood == "surprised":
        lips = [(0, -22.4), (2.9, -24.0), (3.6, -27.0), (2.6, -30.0), (0, -31.2), (-2.6, -30.0), (-3.6, -27.0), (-2.9, -24.0)]
        return open_mouth(rgb, u, v, lips, ((0, -31.4), (2.6, 2.2)))
    if mood == "angry":
        lips = [(-6.2, -28.0), (-4.6, -25.2), (0, -24.2), (4.6, -25.2), (6.2, -28.0), (3.2, -28.4), (0, -27.6), (-3.2, -28.4)]
        rgb = open_mouth(rgb, u, v, lips, None, [((-1.25, -24.6), (1.15, 1.7)), ((1.25, -24.6), (1.15, 1.7))])
        for sign in (1, -1):
            rgb = line_mouth(rgb, u, v, [(sign * 3.4, 4.6), (sign * 2.6, 2.2), (sign * 2.9, -0.2)], 0.42)
        return rgb
    if mood == "disgusted":
        rgb = line_mouth(rgb, u, v, [(-6.6, -26.6), (-4.2, -24.6), (-1.6, -25.4), (0.8, -24.2), (3.4, -25.6), (6.4, -24.4)])
        tongue = blob(u, v, [(-0.6, -25.0), (1.6, -24.6), (3.6, -25.6), (3.4, -28.6), (1.6, -30.0), (-0.2, -28.4)])
        rgb = fill(rgb, LINE, inside(tongue - 0.45, 0.3))
        rgb = fill(rgb, TONGUE, inside(tongue, 0.3))
        rgb = line_mouth(rgb, u, v, [(1.5, -25.4), (1.6, -27.0), (1.6, -28.2)], 0.3)
        for sign in (1, -1):
            for low in (-9.0, -6.6):
                rgb = line_mouth(rgb, u, v, [(sign * 1.2, low), (sign * 2.6, low + 0.9), (sign * 4.2, low + 0.7)], 0.38)
        return rgb
    if mood == "scared":
        lips = [(-4.6, -24.2), (-2.2, -23.5), (0, -24.0), (2.2, -23.5), (4.6, -24.2), (6.4, -28.2), (3.4, -28.9), (0, -28.2), (-3.4, -28.9), (-6.4, -28.2)]
        rgb = open_mouth(rgb, u, v, lips, ((0, -29.4), (4.0, 1.9)), [((-1.25, -24.0), (1.15, 1.4)), ((1.25, -24.0), (1.15, 1.4))])
        drop = blob(u, v, [(31.5, 17.6), (33.0, 14.2), (31.5, 12.4), (30.0, 14.2)])
        rgb = fill(rgb, (110, 170, 215), inside(drop - 0.25, 0.3))
        return fill(rgb, TEAR, inside(drop + 0.2, 0.3))
    raise ValueError(mood)


def head(side, size, mood="default"):
    d = directions(side, size)
    rgb = np.broadcast_to(np.asarray(SKIN, float), d.shape).copy()
    # Shade towards the neck.
    rgb = fill(rgb, SKIN_SHADE, 0.35 * smooth(-d[..., 2], 0.62, 0.95))
    if side == "right":
        off = np.degrees(np.arccos(np.clip(d[..., 0], -1, 1)))
        ring = np.maximum(np.hypot(d[..., 1], d[..., 2]), 1e-9)
        u, v = off * d[..., 1] / ring, off * d[..., 2] / ring
        for sign in (1, -1):
            rgb = fill(rgb, BLUSH, BLUSHES[mood] * bell(u, v, (sign * 30, -19.5), (5.2, 3.9)))
        rgb = paint_eyelids(rgb, u, v)
        rgb = paint_nose(rgb, u, v)
        rgb = paint_mouth(rgb, u, v, mood)
        points, width = BROWS[mood]
        rgb = fill(rgb, BROW, inside(stroke(u, v, points, width)))
        points = [(-a, b) for a, b in points]
        if mood == "disgusted":
            points = [(a, b + 3.4 * smooth(a, 12, 20)) for a, b in points]
        rgb = fill(rgb, BROW, inside(stroke(u, v, points, width)))
    return paint_ears(paint_hair(rgb, d), d)


# ---- eyes, clothes, rug

def eye(side, size):
    """The front of an eyeball. Eyes look straight ahead from the sides of a round head: the iris sits a bit outwards."""
    d = directions("right", size)
    sign = 1 if side == "left" else -1
    gaze = np.array([1.0, sign * np.tan(np.radians(10.5)), np.tan(np.radians(-2.0))])
    gaze /= np.linalg.norm(gaze)
    across = np.cross([0.0, 0.0, 1.0], gaze)
    across /= np.linalg.norm(across)
    x, y = d @ across, d @ np.cross(gaze, across)
    r = np.degrees(np.arccos(np.clip(d @ gaze, -1, 1)))
    turn = np.arctan2(y, x)
    x, y = r * np.cos(turn), r * np.sin(turn)
    rgb = np.full(d.shape, 255.0)
    iris = np.broadcast_to(np.asarray(IRIS, float), d.shape)
    fibre = 0.5 + 0.3 * np.sin(18 * turn) + 0.2 * np.sin(31 * turn + 1)
    iris = fill(iris, IRIS_LIGHT, smooth(-y, -6, 26) * 0.75 * (0.6 + 0.4 * fibre))
    iris = fill(iris, IRIS_DARK, smooth(r, 27.5, 33))
    rgb = mix(rgb, iris, inside(r - 33.5, 1.2))
    rgb = fill(rgb, (22, 16, 14), inside(r - 17.5, 1.4))
    rgb = fill(rgb, (255, 255, 255), inside(np.hypot(x - 9.5, y - 11.0) - 6.0, 1.0))
    return fill(rgb, (255, 255, 255), 0.75 * inside(np.hypot(x + 10.0, y + 11.0) - 3.0, 1.2))


def cloth(side, size, colours, up):
    """A sleeve or trouser leg around z: cloth at one end up to a cuff, skin beyond. `up`: cloth is at +z."""
    body, cuff, seam = colours
    d = directions(side, size)
    height = d[..., 2] / np.maximum(np.hypot(d[..., 0], d[..., 1]), 1e-9)
    height = (height if up else -height) + 0.12  # in radii, 0 at the hem
    rgb = np.broadcast_to(np.asarray(SKIN, float), d.shape)
    rgb = fill(rgb, SKIN_SHADE, 0.6 * smooth(height, -0.10, 0.0))
    rgb = fill(rgb, body, inside(-height, 0.015))
    rgb = fill(rgb, cuff, inside(np.abs(height - 0.11) - 0.11, 0.015))
    return fill(rgb, seam, inside(np.abs(height - 0.22) - 0.014, 0.015))


def rug(size):
    c = (2 * np.arange(size) + 1) / size - 1
    x, y = np.meshgrid(c, c)
    r, turn = np.hypot(x, y), np.arctan2(y, x)
    base, light, dark = (128, 178, 176), (150, 196, 191), (112, 162, 163)
    rgb = np.broadcast_to(np.asarray(base, float), (size, size, 3))
    soft = 3.0 / size
    band = lambda low, high: inside(np.abs(r - (low + high) / 2) - (high - low) / 2, soft)
    rgb = fill(rgb, light, 0.55 * band(0.86, 0.90))
    rgb = fill(rgb, dark, 0.70 * band(0.93, 2.0))
    rgb = fill(rgb, light, 0.50 * band(0.50, 0.53))
    # Petals, then a ring of dots and one of scallops.
    rgb = fill(rgb, light, 0.55 * inside(r - 0.13 - 0.27 * np.abs(np.cos(4 * turn)) ** 1.6, soft))
    rgb = fill(rgb, dark, 0.60 * inside(r - 0.07 - 0.15 * np.abs(np.cos(4 * turn)) ** 1.6, soft))
    rgb = fill(rgb, light, 0.80 * inside(r - 0.06, soft))
    for ring, count, radius in ((0.62, 20, 0.024), (0.915, 48, 0.010)):
        step = 2 * np.pi / count
        near = (turn / step - np.round(turn / step)) * step
        rgb = fill(rgb, (170, 210, 204), 0.8 * inside(np.hypot(r * np.cos(near) - ring, r * np.sin(near)) - radius, soft))
    rgb = fill(rgb, light, 0.55 * inside(np.abs(r - 0.72 - 0.035 * np.abs(np.sin(12 * turn))) - 0.008, soft))
    return rgb


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path(__file__).resolve().parents[2] / "assets" / "tex")
    out = parser.parse_args().out
    out.mkdir(parents=True, exist_ok=True)

    for mood in BROWS:
        save(out / f"face_{mood}.png", head("right", 512, mood))
    for side, name in (("left", "back"), ("up", "left"), ("down", "right"), ("front", "top")):
        save(out / f"head_{name}.png", head(side, 512), 48)
    for side in ("left", "right"):
        save(out / f"eye_{side}.png", eye(side, 256), 64)
    for side in ("right", "left", "up", "down", "front", "back"):
        save(out / f"sleeve_{side}.png", cloth(side, 256, (GREEN, GREEN_CUFF, GREEN_SEAM), up=False), 16)
        save(out / f"leg_{side}.png", cloth(side, 256, (BLUE, BLUE_CUFF, BLUE_SEAM), up=True), 16)
    save(out / "rug.png", rug(256), 48)

    files = sorted(out.glob("*.png"))
    print(f"{len(files)} images, {sum(f.stat().st_size for f in files) / 1000:.0f} kB")


if __name__ == "__main__":
    main()
