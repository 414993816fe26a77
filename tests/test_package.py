"""The package as a whole: stubs, types, documentation, the check of the processor."""

from __future__ import annotations

import dataclasses
import doctest
import importlib
import inspect
import pkgutil
import subprocess
import sys
from pathlib import Path

import pytest

import fuzzyrs as fz
from fuzzyrs import _fuzzyrs as native


def modules():
    """Every Python module of the package; running `fuzzyrs.__main__` would end the tests."""
    names = [info.name for info in pkgutil.walk_packages(fz.__path__, "fuzzyrs.")]
    return [fz, *(importlib.import_module(name) for name in names if "__main__" not in name)]


def mypy(tmp_path, *arguments):
    done = subprocess.run(
        [sys.executable, "-m", *arguments],
        cwd=tmp_path,  # another folder, so that the installed package is looked at
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_stubs_tell_what_the_native_module_is(tmp_path):
    mypy(tmp_path, "mypy.stubtest", "fuzzyrs._fuzzyrs")


def test_the_package_is_typed_strictly(tmp_path):
    settings = Path(__file__).parents[1] / "pyproject.toml"
    mypy(tmp_path, "mypy", "--config-file", str(settings), "--package", "fuzzyrs")


def test_all_names_are_there_and_no_others():
    assert sorted(fz.__all__) == sorted(set(fz.__all__))
    imported = {
        "animation",
        "annotations",
        "experiments",
        "cli",
        "estimators",
        "recording",
        "report",
        "studies",
    }
    public = {name for name in vars(fz) if not name.startswith("_")} - imported
    assert public == set(fz.__all__) - {"__version__"}
    assert set(native.__all__) - set(fz.__all__) == {"ERROR_KINDS", "write_text"}


def documented():
    """Every public thing with its name: functions, classes and what they have."""
    for module in modules():
        if module is not native:
            yield module.__name__, module
    for owner in [fz, fz.plot, fz.errors]:
        for name in owner.__all__:
            thing = getattr(owner, name)
            if callable(thing):
                yield name, thing
            if inspect.isclass(thing):
                for member in vars(thing):
                    if not member.startswith("_"):
                        yield f"{name}.{member}", getattr(thing, member)


# One word each, and the words are explained by the class.
KINDS = ("Training", "Phase", "Ranges", "Lessons")
SETTINGS = [thing for name, thing in vars(fz).items() if name.endswith(KINDS)]


def test_everything_public_is_documented():
    explained = {
        f"{settings.__name__}.{keyword}"
        for settings in SETTINGS
        for keyword in settings().to_dict()
        if keyword in settings.__doc__
    } | {
        f"{name}.{field.name}"
        for name, thing in vars(fz).items()
        if inspect.isclass(thing) and dataclasses.is_dataclass(thing)
        for field in dataclasses.fields(thing)
        if field.name in (thing.__doc__ or "")
    }
    bare = {name for name, thing in documented() if not inspect.getdoc(thing)}
    assert bare - explained - {"FuzzyrsError.kind", "DivergedError.so_far"} == set()


def test_the_examples_in_docstrings_are_true(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # some write files
    runner, finder = doctest.DocTestRunner(), doctest.DocTestFinder()
    report, found = [], set()
    for module in modules():
        for example in finder.find(module):
            runner.run(example, out=report.append)
            found |= {example.name} if example.examples else set()
    assert "".join(report) == ""
    shown = {"fuzzyrs", "fuzzyrs.TSK", "fuzzyrs.OneOnOne", "fuzzyrs._fuzzyrs.train"}
    assert shown <= found, found


@pytest.mark.parametrize("settings", SETTINGS, ids=lambda settings: settings.__name__)
def test_settings_have_the_same_names_everywhere(settings):
    default = settings()
    keywords = list(inspect.signature(settings).parameters)
    assert list(default.to_dict()) == keywords
    assert settings(**{name: getattr(default, name) for name in keywords}) == default
    assert all(f"{name}=" in repr(default) for name in keywords)
    for name in keywords:
        assert name in settings.__doc__


def test_plain_settings_come_back_from_their_dictionary():
    for settings in [fz.GeneticPhase(mutation=0.3), fz.GeneRanges(), fz.QLambdaTraining(steps=9)]:
        assert type(settings)(**settings.to_dict()) == settings


cpu = sys.modules["fuzzyrs._cpu"]


@pytest.mark.parametrize("machine", ["x86_64", "AMD64"])
@pytest.mark.parametrize(
    ("features", "lacks"),
    [({"sse2", "fma"}, "avx2"), ({"avx2"}, "fma"), (set(), "avx2 and fma")],
)
def test_an_old_processor_is_told_what_it_lacks(monkeypatch, machine, features, lacks):
    monkeypatch.setattr("platform.machine", lambda: machine)
    monkeypatch.setattr(cpu, "_features", lambda: frozenset(features))
    with pytest.raises(ImportError, match=f"lacks {lacks}, which fuzzyrs is built for"):
        cpu.check()


def test_other_processors_are_let_through(monkeypatch):
    monkeypatch.setattr(cpu, "_features", lambda: frozenset({"avx2", "fma", "sse2"}))
    monkeypatch.setattr("platform.machine", lambda: "x86_64")
    cpu.check()
    monkeypatch.setattr(cpu, "_features", lambda: None)
    cpu.check()

    def unreadable():
        raise PermissionError

    monkeypatch.setattr(cpu, "_features", unreadable)
    cpu.check()
    monkeypatch.setattr(cpu, "_features", frozenset)
    monkeypatch.setattr("platform.machine", lambda: "arm64")
    cpu.check()
