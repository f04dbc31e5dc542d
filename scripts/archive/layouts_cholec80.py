"""Cholec80: videos/video01.mp4, phase_annotations/video01-phase.txt, tool_annotations/video01-tool.txt, or all in one folder.

Phases and tools are labelled, no tissue: there is no truth that a region could be compared with.
"""
import re

from . import truth

NAME = "Cholec80"
SAYS = "phases and tools are labelled, no region: nothing but what comes out of any recording"
KEYS = None
VIDEO = re.compile(r"video\d\d")


def folders(_folder):
    return []


def recognises(recording):
    name, here, above = recording.stem, recording.parent, recording.parent.parent
    labels = (above / "phase_annotations" / f"{name}-phase.txt", above / "tool_annotations" / f"{name}-tool.txt",
              here / f"{name}-phase.txt", here / f"{name}-tool.txt")
    return VIDEO.fullmatch(name) is not None and any(path.is_file() for path in labels)


def case(recording, folder):
    return truth.case_of(recording.with_suffix(""), folder)

