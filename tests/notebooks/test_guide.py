"""The pages of the guide: their commands run, and print what the pages show.

The blocks of a page run in order, in one process and one empty folder: each line of a
`bash` block is a call of the command line, a `python` block is executed, a `toml`
block is the file that its first line names. A `text` block is an excerpt of what the
block before it printed, line by line: words are the same, numbers within 1 % or one
unit of the last digit shown; `…` at the end of a line leaves out the rest of it.
"""

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import pytest

from bearingjax import cli
from bearingjax.studies import jax_settings

FOLDER = Path(__file__).parent.parent.parent / "notebooks" / "guide"
PAGES = sorted(FOLDER.glob("*_*.md"))
RUN = ("bash", "python", "toml")
# Long integrations in time take several times as long as the tests compile them: these
# pages run as users do, with the optimiser and stored programs, a process a command.
AS_USERS = ("noise_engineer",)
NUMBER = re.compile(r"((?<![\w.])-?\d+(?:\.\d+)?(?:e[+-]?\d+)?)")


class Block(NamedTuple):
    """A fenced block of a page: its language, its text, and where it starts."""

    language: str
    text: str
    place: str


def blocks(page):
    """Fenced blocks of a page, in order."""
    source = page.read_text(encoding="utf-8")
    return [
        Block(one[1], one[2], f"{page.name}:{source[: one.start()].count(chr(10)) + 1}")
        for one in re.finditer(r"^```(\S*)\n(.*?)^```$", source, re.M | re.S)
    ]


def commands(block):
    """Words of each command, and the file into which its output goes or ''."""
    for line in block.text.replace("\\\n", " ").splitlines():
        words = shlex.split(line, comments=True)
        if words:
            file = words[-1] if ">" in words else ""
            yield words[:-2] if file else words, file


def in_a_process(words, cache):
    """Exit status, output and errors of a command in a process of its own."""
    done = subprocess.run(
        [sys.executable, "-m", "bearingjax", *words],
        env={**os.environ, "XLA_FLAGS": "", "XDG_CACHE_HOME": str(cache)},
        capture_output=True,
        text=True,
    )
    return done.returncode, done.stdout, done.stderr


def same(shown, printed):
    """Whether a line of an excerpt agrees with one that was printed."""
    shown, printed = (NUMBER.split(" ".join(x.split())) for x in (shown, printed))
    if shown[-1].endswith("…"):
        shown[-1] = shown[-1].removesuffix("…").rstrip()
        if len(printed) >= len(shown):
            printed = printed[: len(shown)]
            printed[-1] = printed[-1][: len(shown[-1])].rstrip()
    if len(shown) != len(printed) or shown[::2] != printed[::2]:
        return False
    for a, b in zip(shown[1::2], printed[1::2], strict=True):
        last = 10.0 ** -len(a.partition(".")[2].partition("e")[0])
        if abs(float(a) - float(b)) > max(1.001 * last, 0.01 * abs(float(a))):
            return False
    return True


def check_excerpt(block, printed):
    """Fail unless the lines of an excerpt were printed, in this order."""
    rest = printed.splitlines()
    for line in block.text.splitlines():
        found = [k for k, other in enumerate(rest) if same(line, other)]
        assert found, f"{block.place}: not printed: {line}\nin:\n{printed}"
        rest = rest[found[0] + 1 :]


@pytest.mark.usefixtures("untyped")
@pytest.mark.slow
@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_page_prints_what_it_shows(page, tmp_path, monkeypatch, capsys):
    """Numbers within 1 %: rounding and other processors stay below."""
    monkeypatch.setattr(jax_settings, "configure", lambda options: None)
    monkeypatch.chdir(tmp_path)
    names, printed = {"__name__": page.stem}, ""
    for block in blocks(page):
        if block.language == "text":
            check_excerpt(block, printed)
            continue
        if block.language == "toml":
            name = block.text.split()[1]
            Path(name).write_text(block.text, encoding="utf-8")
        elif block.language == "python":
            exec(compile(block.text, block.place, "exec"), names)
            printed = capsys.readouterr().out
        elif block.language == "bash":
            printed = ""
            for words, file in commands(block):
                if page.stem in AS_USERS:
                    status, out, err = in_a_process(words[1:], tmp_path)
                else:
                    status = cli.main(words[1:])
                    out, err = capsys.readouterr()
                assert status == 0, f"{block.place}: {err}"
                printed += out
                if file:
                    Path(file).write_text(out, encoding="utf-8")


@pytest.mark.parametrize(
    ("shown", "printed", "agree"),
    [
        ("C 29.6 kN", "C  29.61 kN", True),
        ("C 29.6 kN", "C  29.61 kN (given)", False),
        ("C 29.6 kN …", "C  29.61 kN (given) 3", True),
        ("C 29.6 …", "C", False),
        ("life 1000 h", "life 1020 h", False),
        ("life 1e+06 h", "life 1.005e+06 h", True),
        ("tilt -0.078 mrad", "tilt -0.079 mrad", True),
        ("tilt -0.078 mrad", "tilt 0.078 mrad", False),
        ("NU 308", "NJ 308", False),
    ],
)
def test_excerpt_agrees_within_one_per_cent(shown, printed, agree):
    assert same(shown, printed) == agree


def test_pages_hold_blocks_that_run_and_links_that_lead_somewhere():
    assert len(PAGES) == 9
    for page in PAGES:
        before = ""
        for block in blocks(page):
            assert block.language in (*RUN, "text"), block.place
            if block.language == "bash":
                assert all(w[0] == "bearingjax" for w, _ in commands(block)), block
            if block.language == "toml":
                assert re.match(r"# \w+\.toml\n", block.text), block.place
            if block.language == "text":
                assert before in ("bash", "python", "text"), block.place
            before = block.language
        text = page.read_text(encoding="utf-8")
        assert text.count("```") == 2 * len(blocks(page)), page.name
        for target in re.findall(r"\]\((?!http)([^)#]+)[^)]*\)", text):
            assert (FOLDER / target).exists(), f"{page.name}: {target}"
