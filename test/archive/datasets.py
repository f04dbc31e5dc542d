"""Small data sets with the layouts of those that the field knows, made of textures that move by a known way."""
import cv2
import numpy as np
import yaml
from conftest import texture

RATE = 25.0
SIZE = (200, 160)
BOX = (60.0, 50.0, 60.0, 50.0)
# A lens that bends by some px, and cameras side by side.
M = np.array([[220.0, 0.0, 100.0], [0.0, 220.0, 80.0], [0.0, 0.0, 1.0]])
D = np.array([[-0.15, 0.02, 0.0, 0.0, 0.0]])
TURN = cv2.Rodrigues(np.array([0.02, -0.01, 0.01]))[0]
T = np.array([[-5.0, 0.1, 0.05]])


def shift(image):
    """px, by which everything has moved since the first image."""
    return np.array([6.0 * np.sin(0.1 * image), 4.0 * np.sin(0.07 * image)])


def views(images, seed=1):
    picture = texture(seed, *SIZE)
    for image in range(images):
        yield cv2.warpAffine(picture, np.column_stack([np.eye(2), shift(image)]), SIZE, borderMode=cv2.BORDER_REFLECT)


def write_video(path, pictures):
    path.parent.mkdir(parents=True, exist_ok=True)
    writer = None
    for picture in pictures:
        writer = writer or cv2.VideoWriter(str(path), cv2.VideoWriter_fourcc(*"MJPG"), RATE, picture.shape[1::-1])
        assert writer.isOpened()
        writer.write(picture)
    writer.release()
    return path


def as_the_lens_sees(rectified):
    """Raw pictures of the left camera, of what is to be seen after rectification."""
    r1, _, p1, *_ = cv2.stereoRectify(M, D, M, D, SIZE, TURN, T.reshape(3, 1), flags=cv2.CALIB_ZERO_DISPARITY, alpha=0.0)
    grid = np.stack(np.meshgrid(np.arange(SIZE[0], dtype=np.float64), np.arange(SIZE[1], dtype=np.float64)), axis=-1).reshape(-1, 1, 2)
    places = cv2.undistortPoints(grid, M, D, R=r1, P=p1).reshape(SIZE[1], SIZE[0], 2).astype(np.float32)
    for picture in rectified:
        yield cv2.remap(picture, places, None, cv2.INTER_CUBIC, borderMode=cv2.BORDER_REFLECT)


def box_at(image):
    x, y = np.array(BOX[:2]) + shift(image)
    return float(x), float(y), BOX[2], BOX[3]


def surgt_truth(images, hidden=(), difficult=()):
    """With tuples, as SurgT's labelling writes them."""
    return {image: [image not in hidden, image in difficult, None if image in hidden else [box_at(image), box_at(image)]] for image in range(images)}


def write_surgt(folder, images=60, hidden=range(20, 25), difficult=range(30, 33), stack="vertical", left=None):
    """Returns the video. `left`: what its left view shows after rectification; the right view shows something else."""
    join = np.vstack if stack == "vertical" else np.hstack
    video = write_video(folder / "video.avi", (join(both) for both in zip(as_the_lens_sees(left or views(images)), views(images, seed=7))))
    info = {"name_video": "video.avi", "video_stack": stack, "resolution": {"width": SIZE[0], "height": SIZE[1]}, "name_ground_truth": ["gt_rectified_0.yaml"]}
    (folder / "info.yaml").write_text(yaml.safe_dump(info), encoding="utf-8")
    (folder / "gt_rectified_0.yaml").write_text(yaml.dump(surgt_truth(images, hidden, difficult)), encoding="utf-8")
    storage = cv2.FileStorage(str(folder / "calibration.yaml"), cv2.FILE_STORAGE_WRITE)
    for name, value in (("M1", M), ("D1", D), ("M2", M), ("D2", D), ("R", TURN), ("T", T)):
        storage.write(name, value)
    storage.release()
    return video


def write_spots(path, points, size=SIZE):
    path.parent.mkdir(parents=True, exist_ok=True)
    picture = np.zeros((size[1], size[0], 3), np.uint8)
    for x, y in points:
        picture[y - 2:y + 3, x - 2:x + 3] = 255  # its centre, x + 5 // 2, is the point
    cv2.imwrite(str(path), picture)


POINTS = [(70, 60), (125, 90)]


def write_stir(folder, images=40):
    """A collection with both views of a clip; returns the left video."""
    ends = [tuple(np.rint(np.array(point) + shift(images - 1)).astype(int)) for point in POINTS]
    for side in ("left", "right"):
        clip = folder / side / "seq00"
        write_video(clip / "frames" / "0ms-1600ms-visible.avi", views(images))
        write_spots(clip / "segmentation" / "icgstartseg.png", POINTS)
        write_spots(clip / "segmentation" / "icgendseg.png", ends)
    return folder / "left" / "seq00" / "frames" / "0ms-1600ms-visible.avi"


CORNERS = np.array([(60.0, 50.0), (130.0, 54.0), (126.0, 106.0), (56.0, 100.0)])


def write_pot(folder, images=41, covered=(11, 13)):
    """V01_1 with every other image annotated; returns the video."""
    annotation = folder / "annotation"
    annotation.mkdir(parents=True)
    rows = [(CORNERS + shift(image)).ravel() if image == 0 or image % 2 else np.zeros(8) for image in range(images)]
    (annotation / "V01_1_gt_points.txt").write_text("".join(" ".join(f"{v:.4f}" for v in row) + "\n" for row in rows), encoding="utf-8")
    (annotation / "V01_1_flag.txt").write_text("".join(f"{int(image in covered)}\n" for image in range(images)), encoding="utf-8")
    return write_video(folder / "V01" / "V01_1.avi", views(images))


def write_cholec80(folder, images=30):
    for kind, header, row in (("phase", "Frame\tPhase", "0\tPreparation"), ("tool", "Frame\tGrasper", "0\t1")):
        path = folder / f"{kind}_annotations" / f"video01-{kind}.txt"
        path.parent.mkdir(parents=True)
        path.write_text(f"{header}\n{row}\n", encoding="utf-8")
    return write_video(folder / "videos" / "video01.avi", views(images))
