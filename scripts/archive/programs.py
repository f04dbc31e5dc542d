"""The package's own programs, and how they are called."""
import os
import pathlib

PACKAGE = "laparoscope_servo"


class NotFound(Exception):
    """A program of the package is not built, or its workspace is not sourced."""


def program(name):
    """Path of a compiled program, in the workspaces that were sourced."""
    prefixes = [p for p in os.environ.get("CMAKE_PREFIX_PATH", "").split(":") if p]
    for prefix in prefixes:
        path = pathlib.Path(prefix) / "lib" / PACKAGE / name
        if os.access(path, os.X_OK):
            return str(path)
    raise NotFound(f"there is no program {name} in CMAKE_PREFIX_PATH ({':'.join(prefixes) or 'which is empty'}): "
                   "source the workspace's devel/setup.bash")


def exit_status(status):
    """Of a process as subprocess has it, negative by a signal, from what os.wait4 says: os.waitstatus_to_exitcode is newer than Python 3.8."""
    return -os.WTERMSIG(status) if os.WIFSIGNALED(status) else os.WEXITSTATUS(status)


def source_options(row):
    """Options of track_bag and describe_recording that say which images are meant, of a line of a manifest."""
    names = {"start": "--start", "end": "--end", "image_topic": "--image-topic", "camera_info": "--camera-info", "params": "--params",
             "crop": "--crop"}
    return [f"{option}={row[column]}" for column, option in names.items() if row.get(column)]
