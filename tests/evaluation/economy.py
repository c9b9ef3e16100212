#!/usr/bin/env python3
"""Counts what is to become less: lines, constants, gates, long functions, and things said in many places.

    python3 tests/evaluation/economy.py             the counts beside economy.json; fails if one has risen
    python3 tests/evaluation/economy.py --rewrite   writes the counts into economy.json
    python3 tests/evaluation/economy.py --list KEY  the places of one count, one a line

"Rust" below is src/**/*.rs with comments, strings and tests taken out, without tables that a script wrote. A test
is an item below `#[cfg(test)]` and what it holds, and a file or folder whose `mod` stands below that attribute or that is called
tests, testing or *_tests. Lines are those of rustfmt and Biome. Counts are taken line by line, so that anyone
can repeat them with grep; none of them understands the program.
"""

import json
import re
import sys
from bisect import bisect
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
KEPT = Path(__file__).with_suffix(".json")
LONG_FUNCTION = 60

NUMBER = r"(?:f64|f32|[iu](?:8|16|32|64|128|size))"
CONSTANT = re.compile(rf"^\s*(?:pub(?:\([^)]*\))? )?const ([A-Z][A-Z0-9_]*): {NUMBER} =")
FIELD = re.compile(rf"^\s*pub \w+: (?:Option<)?{NUMBER}>?,")
COMPARISON = re.compile(r" [<>]=? | [<>]=?$|\.(?:min|max|clamp)\(")
FUNCTION = re.compile(r"^(\s*)(?:pub(?:\([^)]*\))? )?(?:const )?fn (\w+)", re.M)
UNITS = {"M", "M2", "PX", "DEG", "SINE", "COS", "COSINE", "NATS", "SIGMAS"}
# Words that name no quantity: a constant that consists of these and units only says how much, not of what.
ADJECTIVES = set(
    """ABOVE ACCEPTED AHEAD ALIGNED ALLOWED ALONE ALONG ALMOST ALL ANY APART AROUND BEFORE BEHIND BELOW BESIDE BEST
    BEYOND BLOCKED BORNE BOTH BY CANDIDATE CLEAR CLOSE CLOSED COARSE COARSEST COMPARED COVERED DARK DEEPEST
    DIFFERENT DOUBTFUL DRAWN EACH ENOUGH EVERY EXACT EXPLAINED FAR FARTHER FARTHEST FEW FEWEST FIFTH FINAL FINE
    FINEST FLAT FIRST FOLDED FULL FURTHEST GROSS GUESSED HIGHEST HOLDS IN INDEPENDENT INSIDE JOINED KEPT LARGE
    LARGEST LAST LEAST LEVEL LIKELY LONG LONGEST LOWEST MATCHED MAX MEETING MIN MIXED MOST NARROWEST NEAR NEARER
    NEAREST NEARLY NEW NEXT NO NOBODY OCCLUDED OF OFF ON ONE OUTSIDE OVER OWN PARALLEL PLANAR QUICK REDUCE REDUCED
    ROOFED ROUNDED SAME SATURATED SEARCHED SHORT SHORTEST SHOWN SIGNIFICANT SMALL SMALLEST SNAP SPLIT SQUARE
    STANDS STAYS STEEPEST STRAIGHT SURE SYMMETRIC TALLEST TILTED TO TRIED TWO UNCHANGED UNDECIDED
    UNIQUE UNSEEN WEAK WIDEST WITH WITHIN WRITTEN""".split()
)
# Nouns that alone do not say of what.
COUNTERS = {"ROUND", "ROUNDS", "STEP", "STEPS", "TURNS", "TABLE", "SCALE"}


# --- Rust -------------------------------------------------------------------------------------------------

WORDS = re.compile(
    r"""//[^\n]* | /\*.*?\*/
      | b?r(\#*)".*?"\1 | b?"(?:\\.|[^"\\])*"
      | b?'(?:\\(?:u\{[^}]*\}|x..|.)|[^'\\\n])'""",
    re.X | re.S,
)


def blanked(text):
    """The same text with comments, strings and characters as spaces; lines and columns stay."""
    return WORDS.sub(lambda found: re.sub(r"[^\n]", " ", found[0]), text)


def end_of_item(code, start):
    """Where the item that begins at `start` ends: its closing brace, or a semicolon before any brace."""
    depth = 0
    for found in re.compile(r"[{};(\[\])]").finditer(code, start):
        sign = found[0]
        if sign in "{([":
            depth += 1
        elif sign in "})]":
            depth -= 1
            if sign == "}" and depth == 0:
                return found.end()
        elif depth == 0:
            return found.end()
    return len(code)


class Source:
    """A file of Rust: its text, and its code, in which tests are blank."""

    def __init__(self, path):
        self.path = path
        self.name = path.relative_to(ROOT).as_posix()
        self.text = path.read_text()
        code = blanked(self.text)
        self.lines_with_tests = [line for line in code.split("\n") if line.strip()]
        self.test_modules = []
        for found in reversed(list(re.finditer(r"^\s*#\[cfg\((?:all\()?test\b[^\]]*\)\]", code, re.M))):
            end = end_of_item(code, found.end())
            named = re.search(r"\bmod (\w+);", code[found.end() : end])
            if named:
                self.test_modules.append(named[1])
            code = code[: found.start()] + re.sub(r"[^\n]", " ", code[found.start() : end]) + code[end:]
        self.code = code
        self.lines = code.split("\n")

    def tests(self):
        """Paths of its modules that are tests."""
        home = self.path.parent if self.path.name in ("mod.rs", "lib.rs", "main.rs") else self.path.with_suffix("")
        return [home / name for name in self.test_modules]


def rust_sources():
    """All files of Rust, and those among them that are no tests."""
    paths = sorted((ROOT / "src").rglob("*.rs"))
    every = [Source(path) for path in paths if "do not edit" not in path.open().readline()]
    tests = {path for source in every for path in source.tests()}

    def is_test(source):
        above = [source.path.with_suffix(""), *source.path.parents]
        return any(at in tests or re.fullmatch(r"tests|testing|\w+_tests", at.name) for at in above if at > ROOT / "src")

    return every, [source for source in every if not is_test(source)]


def places(sources, pattern, where=lambda name: True):
    """File and line of each line of code in which a pattern is found."""
    return [
        f"{source.name}:{i + 1}: {line.strip()}"
        for source in sources
        if where(source.name)
        for i, line in enumerate(source.lines)
        if pattern.search(line)
    ]


CROSS = re.compile(r"\bperp\(|\b(\w+)[\w.]*(?:\.x|\[0\]) \* (\w+)[\w.]*(?:\.y|\[1\]) - (?:\1|\2)\b")
SUMMED = re.compile(r"\.sum(?:::<f64>)?\(|\+= |\bsum \+|\.fold\(")


def ring_areas(sources):
    """Lines with a cross product in the plan (`a.perp(&b)`, `a.x * b.y - b.x * a.y`) within 3 lines of a sum."""
    for source in sources:
        for i, line in enumerate(source.lines):
            if CROSS.search(line) and any(SUMMED.search(near) for near in source.lines[max(i - 3, 0) : i + 4]):
                yield f"{source.name}:{i + 1}: {line.strip()}"


def functions(source):
    """First line, length in lines and name of each function: from `fn` to its closing brace."""
    starts = [0]
    for found in re.finditer("\n", source.code):
        starts.append(found.end())
    for found in FUNCTION.finditer(source.code):
        end = end_of_item(source.code, found.end(2))
        first = bisect(starts, found.start(2))
        yield first, bisect(starts, end - 1) - first + 1, found[2]


def constants(source):
    """Line, name and whether there is a comment above or beside it, of each numeric constant.

    Constants that follow each other without a line between them share the comment above the first.
    """
    text = source.text.split("\n")
    explained = False
    for i, line in enumerate(source.lines):
        found = CONSTANT.match(line)
        if re.match(r"\s*//[^!]", text[i]):
            explained = True
        elif found:
            yield i + 1, found[1], explained or "//" in text[i]
        elif not re.match(r"\s*(?:#\[|(?:pub(?:\([^)]*\))? )?const )", text[i]):
            explained = False


def is_adjective(name):
    words = [word for word in name.split("_") if word not in UNITS]
    return all(word in ADJECTIVES for word in words) or (len(words) == 1 and words[0] in COUNTERS)


def deciding(sources):
    """Constants whose name stands, in the file of the constant, on a line with a comparison or min, max or clamp."""
    for source in sources:
        for number, name, _ in constants(source):
            used = re.compile(rf"\b{name}\b")
            lines = (line for i, line in enumerate(source.lines) if i + 1 != number and used.search(line))
            if any(COMPARISON.search(line) for line in lines):
                yield f"{source.name}:{number}: {name}"


def face(library):
    """Public names of src/lib.rs: modules and what is re-exported."""
    code = library.code
    yield from re.findall(r"^pub mod (\w+)", code, re.M)
    for names in re.findall(r"^pub use ([^;]*);", code, re.M):
        for name in re.sub(r"\s", "", names.split("{")[-1].rstrip("} \n")).split(","):
            if name:
                yield name.split("::")[-1]


# --- The page ---------------------------------------------------------------------------------------------


def page_files():
    return [path for path in sorted((ROOT / "www/src").rglob("*.ts*")) if not path.parts[-2].startswith("pkg")]


def without_comments(text):
    return re.sub(r"/\*.*?\*/|(?<!:)//[^\n]*", lambda found: re.sub(r"[^\n]", " ", found[0]), text, flags=re.S)


def page():
    stages_ts = ROOT / "www/src/shared/stages.ts"
    stages = re.findall(r'^    name: "(\w+)"', stages_ts.read_text(), re.M)
    names_stage = re.compile(rf'"(?:{"|".join(stages)})"|^\s*(?:{"|".join(stages)}): [{{(\[]', re.M)
    home = ROOT / "www/src/stages"
    lines, files, switches = [], [], []
    for path in page_files():
        name = path.relative_to(ROOT).as_posix()
        text = path.read_text()
        lines += [name] * text.count("\n")
        code = without_comments(text)
        if path != stages_ts and home not in path.parents and names_stage.search(code):
            files.append(name)
        for found in re.finditer(r"\bswitch \(([^{]*)\) \{", code):
            if re.search(r"\b(?:stage|step|tab|kind)\b", found[1]):
                switches.append(f"{name}:{code.count(chr(10), 0, found.start()) + 1}: switch ({found[1]})")
    return lines, files, switches


# --- What is counted --------------------------------------------------------------------------------------


def count():
    """Each count: its key, what it is, and its places."""
    every, sources = rust_sources()
    found = [(source, *constant) for source in sources for constant in constants(source)]
    in_params = lambda name: name.startswith("src/base/params/")
    lines, files, switches = page()
    return {
        "rust_lines": (
            "lines of Rust with code, without tests",
            [source.name for source in sources for line in source.lines if line.strip()],
        ),
        "rust_lines_with_tests": (
            "the same with tests",
            [source.name for source in every for _ in source.lines_with_tests],
        ),
        "page_lines": ("lines of www/src", lines),
        "constants": (
            "`const NAME: f64` and other numbers, in Rust",
            [f"{source.name}:{at}: {name}" for source, at, name, _ in found],
        ),
        "constants_without_comment": (
            "those without a comment above or beside them",
            [f"{source.name}:{at}: {name}" for source, at, name, explained in found if not explained],
        ),
        "constants_without_noun": (
            "those whose name says no quantity (ADJECTIVES and units alone, or COUNTERS)",
            [f"{source.name}:{at}: {name}" for source, at, name, _ in found if is_adjective(name)],
        ),
        "deciding_constants": (
            "those on a line with <, >, <=, >=, min, max or clamp, in their file",
            list(deciding(sources)),
        ),
        "parameters": ("numeric public fields in src/base/params", places(sources, FIELD, in_params)),
        "long_functions": (
            f"functions of more than {LONG_FUNCTION} lines, in Rust",
            [
                f"{source.name}:{at}: {name} {length}"
                for source in sources
                for at, length, name in functions(source)
                if length > LONG_FUNCTION
            ],
        ),
        "ring_areas": (
            "areas of a ring: a cross product in the plan within 3 lines of a sum",
            list(ring_areas(sources)),
        ),
        "crossing_tests": (
            "lines with the test of a ray against an edge (`(a > y) != (b > y)`)",
            places(sources, re.compile(r"\((\w+)\.y > (\w+(?:\.y)?)\) != \(\w+\.y > \2\)")),
        ),
        "cauchy_weights": (
            "lines with Cauchy's weight (`1.0 / (1.0 + e / c)`, not exp)",
            places(sources, re.compile(r"1\.0 / \(1\.0 \+ (?!(?:[\w:]+::)?exp\()")),
        ),
        "damping_schedules": (
            "lines that raise a damping (`damping *= `)",
            places(sources, re.compile(r"\b(?:damping|lambda) \*= ")),
        ),
        "method_matches": (
            "comparisons with a method, outside src/base/params",
            places(
                sources,
                re.compile(r"[!=]= Method::|\bmatch [\w.]*method\b|matches!\([\w.]*method\b"),
                lambda name: not in_params(name),
            ),
        ),
        "adjacency_files": (
            "files outside src/planes/adjacency with the word adjacency in code or comment",
            [
                source.name
                for source in sources
                if "adjacency" in source.text.lower() and not source.name.startswith("src/planes/adjacency/")
            ],
        ),
        "stage_files": ("files of the page that name a stage, outside stages/ and shared/stages.ts", files),
        "switches": ("switches of the page over a stage, tab or kind", switches),
        "public_names": (
            "modules and re-exports of src/lib.rs",
            list(face(next(source for source in every if source.name == "src/lib.rs"))),
        ),
    }


def main(arguments):
    counts = count()
    if arguments[:1] == ["--list"]:
        print("\n".join(counts[arguments[1]][1]))
        return 0
    now = {key: len(where) for key, (_, where) in counts.items()}
    if arguments == ["--rewrite"]:
        KEPT.write_text(json.dumps(now, indent=2) + "\n")
    before = json.loads(KEPT.read_text())
    for key, (what, _) in counts.items():
        print(f"{before.get(key, 0):7} {now[key]:7}  {key}: {what}")
    risen = [key for key in now if now[key] > before.get(key, 0)]
    if risen:
        print(f"\nRisen: {', '.join(risen)}. `--list KEY` names the places.")
    elif now != before:
        print("\nFallen: write it down with `python3 tests/evaluation/economy.py --rewrite`.")
    return 1 if risen else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
