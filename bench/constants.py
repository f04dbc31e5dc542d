"""The tuned numbers of the sources: `constexpr double|float|int k... = NUMBER;`, and each number of a `constexpr TYPE k... = {NUMBERS};`."""
import re

FOLDER = {"tracker": "src/tracking", "controller": "src/servo"}
NUMBER = re.compile(r"^( *)(?:inline )?constexpr (double|float|int) (k\w+) =\s+([-+.0-9e][-+*/.0-9e ]*)f?;", re.MULTILINE)
NUMBERS = re.compile(r"^( *)constexpr (\w+) (k\w+) = \{([-+.0-9e, ]+)\};", re.MULTILINE)


def numbers_of(text):
    """By name: type and number, as they stand in the source."""
    numbers = {m[3]: (m[2], m[4].strip()) for m in NUMBER.finditer(text)}
    for m in NUMBERS.finditer(text):
        numbers.update({f"{m[3]}[{k}]": ("double", number.strip()) for k, number in enumerate(m[4].split(","))})
    return numbers


def sources_of(root, part):
    """Files of a part that hold such numbers."""
    files = [p for p in sorted((root / FOLDER[part]).rglob("*")) if p.suffix in (".h", ".cpp")]
    return {p: numbers for p in files if (numbers := numbers_of(p.read_text(encoding="utf-8")))}
