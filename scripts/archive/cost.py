#!/usr/bin/python3
"""Memory and time that a line is given, from what tracking took where it was measured (doc/archives.md, "Cost"); and what an archive will take:

  scripts/archive/cost.py HOURS WIDTHxHEIGHT RATE [--cores 2,64,1024] [--megabits 8] [--storage 100]
"""
import argparse
import math

# s of one core an image: a + b x megapixels. Decoding H.264 and tracking together, of the slowest clips that were measured; decoding alone.
SECONDS_AN_IMAGE, SECONDS_A_MEGAPIXEL = 0.012, 0.022
TRACKED_AN_IMAGE, TRACKED_A_MEGAPIXEL = 0.0020, 0.0095  # of a region that is TRACKING throughout: bench/archive.py
DECODING_AN_IMAGE, DECODING_A_MEGAPIXEL = 0.0003, 0.0045
SECONDS_OF_A_PAGE, IMAGES_OF_A_PAGE = 10.0, 10000.0  # each line's page; images a second
# MB: the program with its libraries, and a megapixel of the image: of decoder, pyramids, keyframes
MEGABYTES, MEGABYTES_A_MEGAPIXEL = 250, 150
MEGABYTES_OF_A_PAGE, MEGABYTES_AN_IMAGE = 250, 0.003
MARGIN = 3.0  # an archive's worst case beside the measured ones, and processors that are slower
LEAST_MINUTES = 5  # of starting, and of storage that is slow at first
UNKNOWN_HOURS = 4.0  # length of a recording that does not say how long it is
UNKNOWN_RATE = 60.0  # Hz


def images(row):
    return int(row["images"]) or UNKNOWN_HOURS * 3600 * UNKNOWN_RATE


def megapixels(row):
    return int(row["width"]) * int(row["height"]) / 1e6


def megabytes(row):
    """The page is made when tracking has ended."""
    return math.ceil(max(MEGABYTES + MEGABYTES_A_MEGAPIXEL * megapixels(row), MEGABYTES_OF_A_PAGE + MEGABYTES_AN_IMAGE * images(row)))


def tracking(row):
    return images(row) * (SECONDS_AN_IMAGE + SECONDS_A_MEGAPIXEL * megapixels(row))


def decoding(row):
    return images(row) * (DECODING_AN_IMAGE + DECODING_A_MEGAPIXEL * megapixels(row))


def given(seconds):
    return LEAST_MINUTES + math.ceil(MARGIN * seconds / 60)


def minutes(row):
    """Of a line; of one in pieces, what is left when they are there."""
    return given((tracking(row) if int(row["pieces"]) == 1 else 0.0) + SECONDS_OF_A_PAGE + images(row) / IMAGES_OF_A_PAGE)


def minutes_of_piece(row):
    """What lies before a piece is decoded."""
    return given(decoding(row) + tracking(row) / int(row["pieces"]))


def wanted(p, text, name, separator):
    """Numbers more than 0, of an argument."""
    try:
        values = [float(part) for part in text.split(separator)]
    except ValueError:
        values = [0.0]
    if not all(0.0 < value < math.inf for value in values):
        p.error(f"{name} is '{text}', expected more than 0")
    return values


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("hours", help="h of recordings")
    p.add_argument("size", help="px, as 1920x1080")
    p.add_argument("rate", help="Hz")
    p.add_argument("--cores", default="2,64,1024")
    p.add_argument("--megabits", default="8", help="Mbit/s of the recordings")
    p.add_argument("--storage", default="100", help="MB/s that all machines together can read")
    a = p.parse_args()
    (hours,), (rate,) = wanted(p, a.hours, "hours", None), wanted(p, a.rate, "rate", None)
    width, height = wanted(p, a.size, "size", "x") if a.size.count("x") == 1 else p.error(f"size is '{a.size}', expected WIDTHxHEIGHT")
    (megabits,), (storage,) = wanted(p, a.megabits, "--megabits", None), wanted(p, a.storage, "--storage", None)
    count, size = hours * 3600 * rate, width * height / 1e6
    gigabytes = hours * 3600 * megabits / 8 / 1000
    reading = gigabytes * 1000 / storage / 3600
    print(f"{count:.3g} images, {gigabytes:.0f} GB; read at {storage:g} MB/s in {reading:.1f} h")
    for words, an_image, a_megapixel in (("tracked throughout", TRACKED_AN_IMAGE, TRACKED_A_MEGAPIXEL), ("as slow as jobs are planned for", SECONDS_AN_IMAGE, SECONDS_A_MEGAPIXEL)):
        work = count * (an_image + a_megapixel * size) / 3600
        print(f"{words}: {work:.0f} core hours, {3600 * work / hours:.0f} core s for an hour of video")
        for cores in wanted(p, a.cores, "--cores", ","):
            print(f"  {cores:.0f} cores: {max(work / cores, reading):.1f} h" + (", as long as reading takes" if work / cores < reading else ""))


if __name__ == "__main__":
    main()
