"""Made recordings, and the archive's programs as a user runs them."""
import contextlib
import csv
import os
import pathlib
import shutil
import signal
import subprocess
import sys

import cv2
import numpy as np
import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
from archive import files, tracking  # noqa: E402: what is in the package has to be found first

ROI = "60,50,60,50"
PATIENT = "Doe_Jane"  # part of each made recording's path: no result may have it


def texture(seed, width=200, height=160):
    """Smooth random colours, which the tracker takes for tissue."""
    noise = np.random.RandomState(seed).rand(height, width, 3).astype(np.float32)
    smooth = sum(cv2.GaussianBlur(noise, (0, 0), sigma) * sigma for sigma in (1.5, 4.0))
    return cv2.normalize(smooth, None, 20, 235, cv2.NORM_MINMAX).astype(np.uint8)


def write_clip(path, images, seed=1, other_from=None):
    """A video of a picture that moves by up to 6 px; from an image on it is another picture."""
    path.parent.mkdir(parents=True, exist_ok=True)
    picture = texture(seed)
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter_fourcc(*"MJPG"), 25.0, picture.shape[1::-1])
    assert writer.isOpened()
    for k in range(images):
        if k == other_from:
            picture = texture(seed + 100)
        shift = np.float32([[1, 0, 6 * np.sin(0.1 * k)], [0, 1, 4 * np.sin(0.07 * k)]])
        writer.write(cv2.warpAffine(picture, shift, picture.shape[1::-1], borderMode=cv2.BORDER_REFLECT))
    writer.release()
    return path


def write_manifest(path, rows):
    """Rows of (case, file, roi) or dictionaries."""
    rows = [row if isinstance(row, dict) else dict(zip(("case", "file", "roi"), row)) for row in rows]
    columns = list(dict.fromkeys(name for row in rows for name in row))
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, columns, restval="")
        writer.writeheader()
        writer.writerows(rows)
    return path


def call(name, *arguments, status=0):
    """Output of a program of scripts/, both channels; it has to end with this status."""
    done = subprocess.run([ROOT / "scripts" / name, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    text = done.stdout.decode()
    assert done.returncode == status, text
    return text


def plan(folder, rows, *options, status=0):
    """The archive of a manifest with these rows; of the same folder again, its plan is renewed."""
    manifest = write_manifest(folder / "manifest.csv", rows)
    call("archive_manifest", "plan", manifest, folder / "archive", *options, status=status)
    return folder / "archive"


STARTED = []  # every snakemake, each with its jobs a group of processes


def snakemake(archive, *options, profile="local"):
    command = ["/usr/bin/python3", "/usr/bin/snakemake", "--snakefile", ROOT / "workflow" / "Snakefile", "--profile", ROOT / "workflow" / "profiles" / profile,
               "--directory", archive, *options]
    STARTED.append(subprocess.Popen(list(map(str, command)), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True,
                                    env={**os.environ, "USER": os.environ.get("USER", "root")}))  # of which Slurm's executor makes no default
    return STARTED[-1]


@pytest.fixture(autouse=True)
def nothing_goes_on():
    """A test that fails leaves no jobs behind."""
    yield
    while STARTED:
        process = STARTED.pop()
        if process.poll() is None:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()


def run(archive, *options, status=0, profile="local"):
    """What a whole run of the workflow printed."""
    process = snakemake(archive, *options, profile=profile)
    text = process.communicate(timeout=600)[0].decode()
    assert (process.returncode == 0) == (status == 0), text
    return text


def by_hand(archive):
    """All lines one after the other, and the index: what the workflow does, without its decisions."""
    for job in sorted((archive / "private" / "jobs").iterdir()):
        tracking.Line(files.read_json(job), archive).track()
    call("archive_report", "archive", archive)


@pytest.fixture(scope="session")
def clips(tmp_path_factory):
    """Recordings of a hospital: two whole ones, one that is none, one that is cut off."""
    folder = tmp_path_factory.mktemp("hospital") / PATIENT
    write_clip(folder / "a" / "whole.avi", 60)
    write_clip(folder / "b" / "other.avi", 40, seed=2)
    (folder / "b" / "noise.avi").write_bytes(b"this is no video")
    data = (folder / "a" / "whole.avi").read_bytes()
    (folder / "c").mkdir()
    (folder / "c" / "cut.avi").write_bytes(data[:len(data) // 2])
    (folder / "c" / "notes.txt").write_text("no recording", encoding="utf-8")
    return folder


@pytest.fixture(scope="session")
def sets(tmp_path_factory):
    """A folder with each of the data sets, and a recording that is of none."""
    from datasets import write_cholec80, write_pot, write_stir, write_surgt  # it draws its images with what is above
    folder = tmp_path_factory.mktemp("sets")
    write_surgt(folder / "surgt" / "validation" / "case_1" / "1")
    write_stir(folder / "stir" / "7")
    write_pot(folder / "pot")
    write_cholec80(folder / "cholec80")
    write_clip(folder / "other.avi", 20)
    return folder


@pytest.fixture(scope="session")
def proposed(sets, tmp_path_factory):
    """What was said of the data sets, and their manifest."""
    manifest = tmp_path_factory.mktemp("proposed") / "manifest.csv"
    return call("archive_manifest", "propose", sets, manifest), manifest


@pytest.fixture(scope="session")
def planned(proposed, tmp_path_factory):
    """An archive of the data sets, for which nothing has run yet."""
    archive = tmp_path_factory.mktemp("planned") / "archive"
    call("archive_manifest", "plan", proposed[1], archive)
    return archive


@pytest.fixture(scope="session")
def tracked(planned, tmp_path_factory):
    """A copy of it, after a run on this machine; it is only read."""
    archive = tmp_path_factory.mktemp("tracked") / "archive"
    shutil.copytree(planned, archive)
    run(archive)
    return archive
