"""Images with the ROI and its areas drawn into them, as in the paper's figures 3 and 5."""
import pathlib

import cv2
import numpy as np

AREAS = 14  # in each direction
BLUE, RED = (255, 0, 0), (0, 0, 255)


def frames_of(path):
    path = pathlib.Path(path)
    if path.is_dir():
        folder = path / "frames" if (path / "frames").is_dir() else path
        return [cv2.imread(str(f)) for f in sorted(folder.iterdir()) if f.suffix.lower() in (".png", ".jpg", ".jpeg", ".bmp", ".ppm")]
    video, images = cv2.VideoCapture(str(path)), []
    while True:
        ok, image = video.read()
        if not ok:
            return images
        images.append(image)


def quadrilateral(G, x0, y0, x1, y1):
    """Corners of a rectangle of the reference in the image; none where it crosses infinity."""
    p = G @ np.array([[x0, x1, x1, x0], [y0, y0, y1, y1], [1, 1, 1, 1.0]])
    return None if not (p[2] > 1e-9).all() else np.clip((p[:2] / p[2]).T, -1e4, 1e4).round().astype(np.int32)


def draw(image, G, roi, occluded=()):
    """Blue: the ROI in the reference; red: where G takes it; filled: its areas that are occluded."""
    image = image.copy()
    x, y, w, h = roi
    filled = image.copy()
    for k in np.flatnonzero(occluded):
        r, c = divmod(k, AREAS)
        q = quadrilateral(G, x + c * w / AREAS, y + r * h / AREAS, x + (c + 1) * w / AREAS - 1, y + (r + 1) * h / AREAS - 1)
        if q is not None:
            cv2.fillPoly(filled, [q], BLUE)
    image = cv2.addWeighted(filled, 0.6, image, 0.4, 0)
    cv2.rectangle(image, (int(x), int(y)), (int(x + w - 1), int(y + h - 1)), BLUE, 2)
    q = quadrilateral(G, x, y, x + w - 1, y + h - 1)
    if q is not None:
        cv2.polylines(image, [q], True, RED, 2)
    return image
