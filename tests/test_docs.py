"""The Python on the pages of docs/ runs and prints what the page says."""

from __future__ import annotations

import contextlib
import io
import re
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[1] / "docs"
PAGE = DOCS / "coming-from.md"


def blocks():
    """Each block of Python under the heading that it stands under."""
    text = PAGE.read_text(encoding="utf-8")
    sections = re.split(r"^## (.+)$", text, flags=re.MULTILINE)[1:]
    for heading, section in zip(sections[::2], sections[1::2], strict=True):
        for block in re.findall(r"```python\n(.+?)```", section, flags=re.DOTALL):
            yield pytest.param(block, id=heading)


def promised(block):
    """What stands behind `#` after each print."""
    return re.findall(r"^print\(.+\)  # (.+)$", block, flags=re.MULTILINE)


BLOCKS = list(blocks())


# NumPy 2.5 says so of scikit-fuzzy 0.5.0.
@pytest.mark.filterwarnings("ignore:Passing more than 2 positional arguments:DeprecationWarning")
@pytest.mark.parametrize("block", BLOCKS)
def test_blocks_print_what_they_say(block):
    if "simpful" in block:
        pytest.importorskip("simpful", reason="only this test needs simpful")
    names = {}
    if "import" not in block:  # it goes on where the first one ended
        with contextlib.redirect_stdout(io.StringIO()):
            exec(BLOCKS[0].values[0], names)
    with contextlib.redirect_stdout(io.StringIO()) as printed:
        exec(block, names)
    assert printed.getvalue().splitlines() == promised(block)


@pytest.mark.parametrize(
    "page",
    [*sorted(DOCS.glob("chapter-*.md")), DOCS / "learning-from-reward.md", DOCS / "studies.md"],
    ids=lambda page: page.stem,
)
def test_the_blocks_of_a_chapter_print_what_they_say_one_after_the_other(page):
    text = page.read_text(encoding="utf-8")
    names = {}
    for block in re.findall(r"```python\n(.+?)```", text, flags=re.DOTALL):
        with contextlib.redirect_stdout(io.StringIO()) as printed:
            exec(block, names)
        assert printed.getvalue().splitlines() == promised(block)
    assert names


def test_every_library_has_its_block():
    headings = [block.id for block in BLOCKS]
    assert headings == ["fuzzyrs", "scikit-fuzzy", "simpful", "What changes the numbers"]
