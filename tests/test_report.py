"""The report as a text: what is in it, that it needs nothing else, that it is the same again."""

from __future__ import annotations

import base64
import json
import re
import shutil
from html.parser import HTMLParser

import pytest

import fuzzyrs as fz
from fuzzyrs import cli, experiments
from fuzzyrs._html import Html, data, element
from fuzzyrs.experiments.saved import DATABASE
from fuzzyrs.report import build
from fuzzyrs.report.sections import readable
from report_models import ALL, HOSTILE, Known, saved
from small import Small


class Page(HTMLParser):
    """A page as a list of (element, attributes), with the text of each script and style."""

    def __init__(self, text):
        super().__init__()
        self.elements, self.texts, self._raw = [], [], None
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))
        self._raw = tag

    def handle_data(self, data):
        self.texts.append((self._raw, data))

    def all(self, name):
        return [attributes for tag, attributes in self.elements if tag == name]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return saved(tmp_path_factory.mktemp("report"))


@pytest.fixture(scope="module")
def text(folder):
    return build(folder, experiments=ALL).read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def page(text):
    return Page(text)


def cells(text, row):
    """The cells of the lines of a row of a table."""
    body = re.search(rf'<tbody id="{row}".*?</tbody>', text, flags=re.DOTALL)[0]
    lines = re.findall(r"<tr><th scope=\"row\">(.*?)</th>(.*?)</tr>", body)
    return {name: re.findall("<td>(.*?)</td>", line) for name, line in lines}


def test_the_tables_have_the_print_and_ours_side_by_side(text):
    # Seeds 3 to 7: each value is its seed.
    assert cells(text, "table-9-1--1")["time"][:2] == ["5.2", "5.0 [3.0, 7.0]"]
    early, late = cells(text, "table-9-1--2").values()
    assert early[:2] == ["–", "5.00 [3.00, 7.00]"]
    # The last seed has no value, which counts as larger than all others.
    assert late[:2] == ["1.00", "−4.00 [−6.00, –]"]
    assert late[3] == "1"


def test_intervals_are_those_of_the_result(folder, text):
    row = json.loads((folder / "table-9-1.json").read_text(encoding="utf-8"))["rows"][0]
    middle, (low, high) = row["interquartile_mean"][0], row["interval"][0]
    assert cells(text, "table-9-1--1")["time"][2] == f"{middle:.1f} [{low:.1f}, {high:.1f}]"


def test_the_overview_counts_experiments_rows_and_verdicts(text):
    assert "2 of 3 experiments were run; they have 3 rows with 5 numbers" in text
    overview = text[text.index('id="overview"') : text.index('id="claims"')]
    counts = dict(re.findall(r'data-verdict="(\w+)">.*?</span> (\d+)</li>', overview))
    assert (counts["reproduced"], counts["differs"]) == ("1", "1")
    assert 'href="#table-9-1" class="cell verdict-differs"' in overview
    assert 'href="#section-9-4" class="cell verdict-not-run"' in overview


def test_every_link_leads_somewhere(page):
    anchors = {attributes["id"] for _, attributes in page.elements if "id" in attributes}
    links = [attributes["href"] for attributes in page.all("a")]
    inner = {link.removeprefix("#") for link in links if link.startswith("#")}
    missing = inner - anchors
    # Claims of experiments that this report is not about have nowhere to lead.
    assert not any(name.startswith(("table-9", "figure-9", "section-9")) for name in missing)
    assert len(anchors) == sum("id" in attributes for _, attributes in page.elements)


def test_the_page_needs_nothing_else(page, text):
    policy = page.all("meta")[1]["content"]
    assert policy.startswith("default-src 'none'; img-src data:")
    assert "unsafe" not in policy
    for _, attributes in page.elements:
        for key in ("src", "srcset", "data", "poster", "action", "style"):
            assert attributes.get(key, "data:").startswith("data:"), attributes
        for key in attributes:
            assert not key.startswith("on"), attributes
    outside = {a["href"] for a in page.all("a") if not a["href"].startswith("#")}
    assert outside == {"https://doi.org/10.1002/acs.1249"}
    for kind in ("link", "iframe", "object", "base", "form"):
        assert page.all(kind) == []
    style = text[text.index("<style>") : text.index("</style>")]
    assert "url(" not in style
    assert "@import" not in style


def test_figures_lie_in_the_page(folder, page):
    (picture,) = page.all("img")
    kind, _, content = picture["src"].partition(";base64,")
    assert kind == "data:image/svg+xml"
    assert base64.b64decode(content) == (folder / "figure-9-2-curve.svg").read_bytes()
    assert picture["alt"].startswith("Table 9.1: numbers that are known")


def test_large_vector_graphics_are_shown_as_pixels(folder, monkeypatch):
    monkeypatch.setattr("fuzzyrs.report.sections.LARGEST_SVG", 100)
    page = Page(build(folder, experiments=ALL).read_text(encoding="utf-8"))
    assert page.all("img")[0]["src"].startswith("data:image/png;base64,")


def test_figures_are_drawn_if_they_are_missing_or_old(folder, tmp_path):
    mine = shutil.copytree(folder, tmp_path / "mine")
    for path in mine.glob("figure-9-2*"):
        path.unlink()
    build(mine, experiments=ALL)
    figure = mine / "figure-9-2-curve.svg"
    drawn = figure.read_bytes()
    figure.write_text("old")
    (mine / "table-9-1.json").touch()
    build(mine, experiments=ALL)
    assert figure.read_bytes() == drawn
    figure.write_text("newer")
    build(mine, experiments=ALL)
    assert figure.read_text() == "newer"


def test_the_same_results_give_the_same_page(text, tmp_path):
    again = build(saved(tmp_path), experiments=ALL).read_text(encoding="utf-8")

    def without_time(page):
        return re.sub(r"<dt>run</dt><dd>[^<]*</dd>", "", page)

    assert without_time(text) != text
    assert without_time(again) == without_time(text)


def test_texts_are_shown_and_not_obeyed(page, text):
    assert "<img src=x" not in text.replace("&lt;img src=x", "")
    assert all("onerror" not in attributes for _, attributes in page.elements)
    assert any(HOSTILE in words for _, words in page.texts)


def test_each_experiment_has_its_command_its_seeds_and_its_settings(text):
    assert "<code>fuzzyrs reproduce table-9-1 --seeds 5 --seed 3</code>" in text
    assert "<dt>seeds</dt><dd>3 to 7</dd>" in text
    settings = re.search(r"<code>(\{\n  &quot;list.*?)</code>", text, flags=re.DOTALL)[1]
    assert json.loads(settings.replace("&quot;", '"')) == Known().config()
    assert "<code>fuzzyrs reproduce section-9-4</code>" in text


def test_seeds_that_are_no_range_are_named_one_by_one(tmp_path):
    experiments.reproduce(Known(), [1, 4, 7], tmp_path)
    page = build(tmp_path, experiments=[Known()]).read_text(encoding="utf-8")
    assert "<dd>1, 4, 7</dd>" in page
    assert "&quot;table-9-1&quot;)(), [1, 4, 7], Path(" in page


def test_claims_have_their_verdicts_and_lead_to_their_rows(tmp_path):
    result = experiments.reproduce(Small(), range(2), tmp_path)
    for form in ("svg", "png"):  # instead of its figures, which are not what this is about
        (tmp_path / f"table-6-3.{form}").write_text("")
    page = build(tmp_path, experiments=[Small()]).read_text(encoding="utf-8")
    place = [row.name for row in result.rows].index("qlbgflc") + 1
    assert f'<a href="#table-6-3--{place}">Table 6.3, qlbgflc</a>' in page
    claims = page[page.index('id="claims"') : page.index('id="reading"')]
    assert len(re.findall(r'id="claim-\d+"', claims)) == 26
    assert "not run" in claims


def test_a_result_that_cannot_be_used_says_why(folder, tmp_path):
    mine = shutil.copytree(folder, tmp_path / "mine")
    (mine / "table-9-1.json").write_text('{"version": "0.0.0"}')
    page = build(mine, experiments=ALL).read_text(encoding="utf-8")
    assert "it is of fuzzyrs 0.0.0" in page


def test_a_result_older_than_a_row_of_a_claim_is_told(tmp_path):
    experiments.reproduce(Small(), range(2), tmp_path)
    for form in ("svg", "png"):
        (tmp_path / f"table-6-3.{form}").write_text("")
    path = tmp_path / "table-6-3.json"
    path.write_text(path.read_text(encoding="utf-8").replace('"name": "qlbgflc"', '"name": "x"'))
    page = build(tmp_path, experiments=[Small()]).read_text(encoding="utf-8")
    assert "Table 6.3, qlbgflc</a>: <span" in page
    assert "reproduce table-6-3 again" in page


def test_without_the_seeds_everything_but_new_figures_is_shown(folder, tmp_path):
    mine = shutil.copytree(folder, tmp_path / "mine")
    (mine / DATABASE).unlink()
    page = build(mine, experiments=ALL).read_text(encoding="utf-8")
    assert "5.0 [3.0, 7.0]" in page
    assert 'alt="Table 9.1' in page
    assert 'class="player"' in page
    (mine / "figure-9-2-curve.svg").unlink()
    page = build(mine, experiments=ALL).read_text(encoding="utf-8")
    assert "no figures, or old ones: " in page


def test_a_folder_without_results_is_told(tmp_path, capsys):
    with pytest.raises(fz.errors.FileError, match="has no results; make some with"):
        build(tmp_path)
    assert cli.main(["report", "--out", str(tmp_path / "nowhere")]) == 1
    assert "has no results" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_the_command_prints_where_the_report_is(tmp_path, capsys):
    assert cli.main(["reproduce", "table-6-1", "--seeds", "1", "--out", str(tmp_path)]) == 0
    capsys.readouterr()
    assert cli.main(["report", "--out", str(tmp_path)]) == 0
    assert capsys.readouterr().out == f"wrote {tmp_path / 'report.html'}\n"
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    # Every experiment is there, run or not.
    for identifier in experiments.ids():
        assert f'id="{identifier}"' in page
    anchors = set(re.findall(r' id="([^"]+)"', page))
    assert set(re.findall(r'href="#([^"]+)"', page)) <= anchors


def test_ids_are_read_as_they_are_printed():
    assert readable("table-6-3") == "Table 6.3"
    assert readable("section-8-5-scaling") == "Section 8.5 scaling"
    assert [readable(each.id) for each in ALL] == ["Table 9.1", "Figure 9.3", "Section 9.4"]


def test_elements_escape_what_is_not_html():
    assert (
        element("p", "<&", Html("<b>"), class_='"x"') == '<p class="&quot;x&quot;">&lt;&amp;<b></p>'
    )
    assert element("input", hidden=True, id=None, data_a=1) == '<input hidden data-a="1">'
    assert "</script>" not in data({"a": "</script>"})[:-9]
