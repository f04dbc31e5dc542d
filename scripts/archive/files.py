"""Files that are there as a whole or not at all."""
import contextlib
import csv
import json
import os
import pathlib


@contextlib.contextmanager
def whole(path, mode="w", lasting=True):
    """A file to write, which gets its name when everything is written. Of an error, nothing is left over. A `lasting` one is on the
    disk then, also when power fails; what can be written again at any time needs not wait for that."""
    path = pathlib.Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_name(f"{path.name}.{os.getpid()}.partial")
    try:
        with open(partial, mode, **({} if "b" in mode else {"encoding": "utf-8", "newline": ""})) as file:
            yield file
            if lasting:
                file.flush()
                os.fsync(file.fileno())
        os.replace(partial, path)
    finally:
        with contextlib.suppress(FileNotFoundError):
            partial.unlink()


def write_text(path, text, lasting=True):
    with whole(path, lasting=lasting) as file:
        file.write(text)


def write_json(path, value):
    write_text(path, json.dumps(value, indent=1, sort_keys=True) + "\n")


def write_if_changed(path, value):
    """As write_json, but a file with this content keeps its time, from which Snakemake knows what is to be done again."""
    text = json.dumps(value, indent=1, sort_keys=True) + "\n"
    path = pathlib.Path(path)
    if path.is_file() and path.read_text(encoding="utf-8") == text:
        return False
    write_text(path, text, lasting=False)
    return True


def read_json(path):
    return json.loads(pathlib.Path(path).read_text(encoding="utf-8"))


def write_table(path, columns, rows):
    """`rows` are dictionaries; what a row lacks stays empty."""
    with whole(path) as file:
        writer = csv.DictWriter(file, columns, restval="", lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def read_table(path):
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))
