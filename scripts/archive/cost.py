"""Memory and time that a line is given, from what tracking took where it was measured (doc/archives.md, "Cost")."""
import math

# s of one core an image: a + b x megapixels. Decoding H.264 and tracking together, of the slowest clips that were measured; decoding alone.
SECONDS_AN_IMAGE, SECONDS_A_MEGAPIXEL = 0.012, 0.022
DECODING_AN_IMAGE, DECODING_A_MEGAPIXEL = 0.0005, 0.008
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
