"""Names of patients, wherever recordings have them, get into the key and the jobs of the private folder, and nowhere else."""
import gzip
import struct

import genpy
import numpy as np
import rosbag
from archive import files
from conftest import ROI, plan, run, texture, write_clip
from sensor_msgs.msg import Image
from test_workflow import ids, records

NAMES = ("Musterfrau", "Erika", "Heidehof")
WITH_NAMES = ("key.csv", "jobs")  # of the private folder


def with_title(clip):
    """The video with a title among its metadata."""
    title = b"Musterfrau^Erika\0\0"
    info = b"INFO" + b"INAM" + struct.pack("<I", len(title)) + title
    data = bytearray(clip.read_bytes()) + b"LIST" + struct.pack("<I", len(info)) + info
    data[4:8] = struct.pack("<I", len(data) - 8)
    clip.write_bytes(data)
    return clip


def write_bag(path, topics, images=20):
    """All that a bag holds beside pixels has the name: topics, the frame, the node that published."""
    picture = texture(3)
    with rosbag.Bag(str(path), "w") as bag:
        for k in range(images):
            stamp = genpy.Time.from_sec(100.0 + k / 25.0)
            message = Image(height=picture.shape[0], width=picture.shape[1], encoding="bgr8", step=3 * picture.shape[1], data=np.roll(picture, k % 3, 1).tobytes())
            message.header.stamp, message.header.frame_id = stamp, "musterfrau_camera"
            for topic in topics:
                caller = {"topic": topic, "callerid": "/erika", "type": Image._type, "md5sum": Image._md5sum, "message_definition": Image._full_text}
                bag.write(topic, message, stamp, connection_header=caller)
    return path


def contents(path):
    return gzip.decompress(path.read_bytes()) if path.suffix == ".gz" else path.read_bytes()


def test_names_are_nowhere_else(tmp_path):
    hospital = tmp_path / "Heidehof" / "Erika Musterfrau"
    titled = with_title(write_clip(hospital / "musterfrau.avi", 40))
    cut = write_clip(hospital / "Musterfrau cut.avi", 60)
    cut.write_bytes(cut.read_bytes()[:cut.stat().st_size // 2])
    noise = write_clip(hospital / "erika_noise.avi", 10)
    bag = write_bag(hospital / "musterfrau.bag", ["/musterfrau/image_raw"])
    changed = write_bag(hospital / "erika.bag", ["erika/image"])
    params = hospital / "erika.yaml"
    params.write_text("tracking: {esm: {max_iterations: 30}}\n", encoding="utf-8")
    archive = plan(tmp_path, [{"case": "Musterfrau, Erika", "file": titled, "roi": ROI, "params": params}, {"case": "cut Erika", "file": cut, "roi": ROI},
                              {"case": "noise Erika", "file": noise, "roi": ROI}, {"case": "bag Erika", "file": bag, "roi": ROI, "image_topic": "/musterfrau/image_raw"},
                              {"case": "changed Erika", "file": changed, "roi": ROI}])
    noise.write_bytes(b"no video any more")
    write_bag(changed, ["erika/image", "/musterfrau/image"])  # what its topics are is told, for somebody who has to choose one
    run(archive)
    states = {case.split()[0]: records(archive)[identity]["state"] for case, identity in ids(archive).items()}
    assert states == {"Musterfrau,": "done", "cut": "damaged", "noise": "failed", "bag": "done", "changed": "failed"}
    assert "TOPIC" in str(records(archive)[ids(archive)["changed Erika"]]["reasons"])
    everything = [path for path in archive.rglob("*") if path.is_file()]
    kept = [path for path in everything if path.relative_to(archive).parts[0] == "private" and path.relative_to(archive).parts[1] in WITH_NAMES]
    assert len(kept) == 1 + 5 and all(any(name.lower().encode() in contents(path).lower() for name in NAMES) for path in kept)
    logs = {path.stem for path in (archive / "private" / "logs").iterdir()}
    assert logs == set(ids(archive).values()), "each line has its log, below the id of its case"
    for path in sorted(set(everything) - set(kept)):
        for name in NAMES:
            assert name.lower() not in str(path.relative_to(archive)).lower() and name.lower().encode() not in contents(path).lower(), (path, name)
    assert len(files.read_table(archive / "results" / "lines.csv")) == 5
