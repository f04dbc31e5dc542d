"""The tuned numbers of the sources: each of `constexpr double|float|int k... = NUMBER, k... = NUMBER;`, and each number of a
`constexpr TYPE k... = {NUMBERS};`."""
import re

FOLDER = {"tracker": "src/tracking", "controller": "src/servo"}
NUMBER = re.compile(r"(k\w+) =\s+([-+.0-9e][-+*/.0-9e ]*)f?")
ONE = NUMBER.pattern.replace("(", "(?:")
DECLARATION = re.compile(rf"^( *(?:inline )?constexpr (double|float|int)) ({ONE}(?:,\s*{ONE})*);", re.MULTILINE)
NUMBERS = re.compile(r"^( *)constexpr (\w+) (k\w+) = \{([-+.0-9e, ]+)\};", re.MULTILINE)


def numbers_of(text):
    """By name: type and number, as they stand in the source."""
    numbers = {n[1]: (m[2], n[2].strip()) for m in DECLARATION.finditer(text) for n in NUMBER.finditer(m[3])}
    for m in NUMBERS.finditer(text):
        numbers.update({f"{m[3]}[{k}]": ("double", number.strip()) for k, number in enumerate(m[4].split(","))})
    return numbers


def sources_of(root, part):
    """Files of a part that hold such numbers."""
    files = [p for p in sorted((root / FOLDER[part]).rglob("*")) if p.suffix in (".h", ".cpp")]
    return {p: numbers for p in files if (numbers := numbers_of(p.read_text(encoding="utf-8")))}
