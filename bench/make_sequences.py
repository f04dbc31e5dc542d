#!/usr/bin/python3
"""Makes the sequences with known ground truth that report.py measures on when it is given none: synthetic tissue, or a photograph.

Each is a folder with frames/NNNN.png, truth.csv (frame, g00..g22: reference to current pixels, determinant 1, occluded: share of the
ROI that is covered), areas.csv (frame, then the same for each of its 14 x 14 areas, row by row) and scene.json (roi: x, y, width, height
in px; K; noise in grey levels).
  still_sheet  as figures 3 to 5 of Bourger et al. (2007): nothing moves but a sheet (a green drape), over the ROI from frame 10 to 30,
               over 79 % of it (155 of 196 areas) at frame 23
  clear        a moving camera, nothing else
  light        a moving camera, light that changes by 20 %
  instrument   a moving camera, a grey bar that covers up to 60 %
  tissue       a moving camera, other tissue of the same colours that covers up to 60 %
"""
import argparse
import json
import pathlib

import cv2
import numpy as np

SIZE = (640, 480)
ROI = (222, 142, 196, 196)
AREAS = 14   # in each direction
NOISE = 2.0  # grey levels
FOCAL = 700.0
K = np.array([[FOCAL, 0, (SIZE[0] - 1) / 2], [0, FOCAL, (SIZE[1] - 1) / 2], [0, 0, 1.0]])


def tissue(rng):
    """Noise of several scales, each with the same contrast, in the colours of tissue."""
    height = np.zeros((SIZE[1] * 3 // 2, SIZE[0] * 3 // 2), np.float32)
    for scale, contrast in ((2, 0.5), (5, 0.8), (15, 1.0), (50, 1.0)):
        layer = cv2.GaussianBlur(rng.normal(size=height.shape).astype(np.float32), (0, 0), scale)
        height += contrast * layer / layer.std()
    return np.stack([70 + 9 * height, 80 + 13 * height, 150 + 18 * height], -1).astype(np.float32)


def motion(frames, amount, rng):
    """Homographies of a camera that moves smoothly in front of the plane z = 1, from rest."""
    t = np.linspace(0, 1, frames)
    amplitude = amount * np.array([0.05, 0.04, 0.08, 0.06, 0.06, 0.15])
    path = np.stack([a * (np.sin(2 * np.pi * f * t + p) - np.sin(p)) * np.minimum(1, t / 0.2)
                     for a, f, p in zip(amplitude, rng.uniform(0.8, 2.0, 6), rng.uniform(0, 2 * np.pi, 6))], 1)
    for x in path:
        H = cv2.Rodrigues(x[3:])[0] + np.outer(x[:3], [0.2, 0, 0.98])
        G = K @ H @ np.linalg.inv(K)
        yield G / np.cbrt(np.linalg.det(G))


def area_of_pixels():
    """The area that each pixel of the ROI lies in."""
    _, _, w, h = ROI
    return (np.arange(h)[:, None] * AREAS // h) * AREAS + np.arange(w)[None, :] * AREAS // w


def render(out, scene, homographies, cover, occluder, light, rng):
    """`cover`: share of the ROI behind an edge that comes from the left, per frame; `occluder`: an image, or a colour; `light`: gain per
    frame."""
    (out / "frames").mkdir(parents=True, exist_ok=True)
    x, y, w, h = ROI
    to_frame = np.array([[1, 0, (SIZE[0] - scene.shape[1]) / 2], [0, 1, (SIZE[1] - scene.shape[0]) / 2], [0, 0, 1.0]])
    points = np.stack(np.meshgrid(np.arange(x, x + w), np.arange(y, y + h)), -1).reshape(-1, 1, 2).astype(np.float64)
    columns = np.arange(SIZE[0])[None, :, None]
    area_of = area_of_pixels().ravel()
    truth, areas = [], []
    for n, G in enumerate(homographies):
        image = cv2.warpPerspective(scene, G @ to_frame, SIZE, flags=cv2.INTER_CUBIC, borderMode=cv2.BORDER_REFLECT)
        behind = np.zeros(w * h)
        if cover[n] > 0:
            seen = cv2.perspectiveTransform(points, G)[:, 0, 0]
            edge = np.quantile(seen, cover[n])
            behind = (seen <= edge).astype(float)
            share = np.clip(edge + 0.5 - columns, 0, 1).astype(np.float32)
            image = image * (1 - share) + np.asarray(occluder, np.float32) * share
        image = image * light[n] + rng.normal(0, NOISE, image.shape)
        cv2.imwrite(str(out / "frames" / f"{n:04d}.png"), np.clip(image, 0, 255).astype(np.uint8),
                    [cv2.IMWRITE_PNG_COMPRESSION, 1])
        truth.append([n, *G.ravel(), behind.mean()])
        areas.append([n, *(np.bincount(area_of, behind) / np.bincount(area_of))])
    head = "frame," + ",".join(f"g{i}{j}" for i in range(3) for j in range(3)) + ",occluded"
    np.savetxt(out / "truth.csv", truth, delimiter=",", header=head, comments="", fmt="%.10g")
    head = "frame," + ",".join(f"a{k}" for k in range(AREAS * AREAS))
    np.savetxt(out / "areas.csv", areas, delimiter=",", header=head, comments="", fmt="%.4g")
    (out / "scene.json").write_text(json.dumps({"roi": ROI, "K": K.tolist(), "noise": NOISE}))


def make(out, photograph=None, seed=1):
    """Writes all of them below `out` and returns their folders by name."""
    rng = np.random.default_rng(seed)
    scene = tissue(rng)
    if photograph:
        image = cv2.imread(str(photograph), cv2.IMREAD_COLOR)
        if image is None:
            raise SystemExit(f"{photograph}: cannot be read as an image")
        scale = max(s / i for s, i in zip(scene.shape[:2], image.shape[:2]))
        scene = cv2.resize(image, None, fx=scale, fy=scale, interpolation=cv2.INTER_CUBIC).astype(np.float32)
    frames = 100
    t = np.linspace(0, 1, frames)
    still = [np.eye(3)] * 41
    sheet = np.interp(np.arange(41), [9, 23, 31], [0, 155 / 196, 0])
    bar = 0.6 * np.clip(3 * np.minimum(t - 0.2, 0.8 - t) / 0.6, 0, 1)
    none, steady = np.zeros(frames), np.ones(frames)
    other = tissue(np.random.default_rng(seed + 1))[:SIZE[1], :SIZE[0]]
    if photograph:
        other = np.roll(scene[::-1, ::-1], (scene.shape[0] // 3, scene.shape[1] // 3), (0, 1))[:SIZE[1], :SIZE[0]]
    jobs = {
        "still_sheet": (still, sheet, (135, 120, 60), np.ones(41)),
        "clear": (motion(frames, 0.6, rng), none, (0, 0, 0), steady),
        "light": (motion(frames, 0.6, rng), none, (0, 0, 0), 1 + 0.2 * np.sin(2 * np.pi * 1.7 * t)),
        "instrument": (motion(frames, 0.5, rng), bar, (140, 138, 135), steady),
        "tissue": (motion(frames, 0.4, rng), bar, other, steady),
    }
    for name, job in jobs.items():
        if not (out / name / "areas.csv").exists():
            render(out / name, scene, *job, rng)
    return {name: out / name for name in jobs}


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("out", type=pathlib.Path)
    p.add_argument("--photograph", type=pathlib.Path, help="is the scene instead of synthetic tissue")
    p.add_argument("--seed", type=int, default=1)
    a = p.parse_args()
    for folder in make(a.out, a.photograph, a.seed).values():
        print(folder)


if __name__ == "__main__":
    main()
