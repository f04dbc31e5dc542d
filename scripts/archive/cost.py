"""Memory and time that a line is given, from what tracking took where it was measured (doc/archives.md, "Cost")."""
import math

# s of one core an image: a + b x megapixels. Decoding H.264 and tracking together, of the slowest clips that were measured.
SECONDS_AN_IMAGE, SECONDS_A_MEGAPIXEL = 0.012, 0.022
# MB: the program with its libraries, and a megapixel of the image: of decoder, pyramids, keyframes
MEGABYTES, MEGABYTES_A_MEGAPIXEL = 250, 150
MARGIN = 3.0  # an archive's worst case beside the measured ones, and processors that are slower
LEAST_MINUTES = 5  # of starting, and of storage that is slow at first
UNKNOWN_HOURS = 4.0  # length of a recording that does not say how long it is
UNKNOWN_RATE = 60.0  # Hz
REPORT_MEGABYTES, REPORT_SECONDS_A_LINE, REPORT_IMAGES_A_SECOND = 1000, 10.0, 10000.0


def images(row):
    return int(row["images"]) or UNKNOWN_HOURS * 3600 * UNKNOWN_RATE


def megapixels(row):
    return int(row["width"]) * int(row["height"]) / 1e6


def megabytes(row):
    return math.ceil(MEGABYTES + MEGABYTES_A_MEGAPIXEL * megapixels(row))


def minutes(row):
    seconds = images(row) * (SECONDS_AN_IMAGE + SECONDS_A_MEGAPIXEL * megapixels(row))
    return LEAST_MINUTES + math.ceil(MARGIN * seconds / 60)


def report_minutes(rows):
    seconds = sum(REPORT_SECONDS_A_LINE + images(row) / REPORT_IMAGES_A_SECOND for row in rows)
    return LEAST_MINUTES + math.ceil(MARGIN * seconds / 60)
