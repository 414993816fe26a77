"""What runs leave in a folder: finished seeds, results, and the games that are worth watching.

`runs.sqlite` has every finished seed of every experiment, so that an interrupted run goes on and
figures can be drawn without a run. Each result is `ID.json`, its games are `ID.games.json`.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import fuzzyrs._fuzzyrs as native
from fuzzyrs._fuzzyrs import __version__, write_text
from fuzzyrs.errors import FormatError, from_kind
from fuzzyrs.experiments.experiment import Experiment
from fuzzyrs.experiments.result import Result
from fuzzyrs.recording import load_games, save_games
from fuzzyrs.studies.store import Store

DATABASE = "runs.sqlite"


def open_runs(folder: Path, experiment: Experiment) -> Store:
    """Return the finished seeds of an experiment with its config.

    Those of another build of fuzzyrs are not among them: they may have other outcomes.
    """
    config = experiment.config()
    definition = {"config": config, "version": __version__, "build": build()}
    return Store(folder / DATABASE, _name(experiment.id, config, build()), definition)


def _name(identifier: str, config: dict[str, Any], build: str) -> str:
    """Return what the runs of an experiment with a config are called in the database."""
    digest = hashlib.sha256(json.dumps(config).encode()).hexdigest()[:8]
    return f"{identifier} {digest} {build}"


@cache
def build() -> str:
    """Return what tells this build of fuzzyrs from others of the same version."""
    digest = hashlib.sha256(Path(str(native.__file__)).read_bytes())
    for source in sorted(Path(__file__).parent.glob("*.py")):
        digest.update(source.read_bytes())
    return digest.hexdigest()[:16]


def save(folder: Path, result: Result, title: str) -> None:
    """Write a result, and its games if it has any, each file as a whole."""
    games = _games(folder, result.id)
    if result.games:
        save_games(games, result.games, title)
    else:
        games.unlink(missing_ok=True)
    write_text(_result(folder, result.id), result.to_json())


def load(folder: Path, experiment: Experiment) -> Result:
    """Return the saved result of an experiment, with outcomes and games.

    Raises
    ------
    FileError
        If there is none.
    FormatError
        If a file is something else, of another version, or of another config.
    """
    path = _result(folder, experiment.id)
    result = load_shown(folder, experiment)
    name = _name(result.id, result.config, str(result.run.get("build")))
    with Store(folder / DATABASE, name, None) as runs:
        outcomes = {run.seed: run.outcome for run in runs.runs()}
    kept = [outcome for seed in result.seeds if (outcome := outcomes.get(seed)) is not None]
    if len(kept) < len(result.seeds):
        message = f"{runs.path} has not all seeds of {path}; reproduce it again"
        raise from_kind("format", message)
    return replace(result, outcomes=kept)


def load_shown(folder: Path, experiment: Experiment) -> Result:
    """Return the saved result of an experiment as `load` does, but without outcomes."""
    games = _games(folder, experiment.id)
    recorded = load_games(games)[1] if games.exists() else []
    return replace(load_table(folder, experiment), games=recorded)


def load_table(folder: Path, experiment: Experiment) -> Result:
    """Return the saved result of an experiment as `load` does, but without outcomes and games."""
    path = _result(folder, experiment.id)
    try:
        result = Result.from_json(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise from_kind("file", f"cannot read {path}: {error.strerror or error}") from error
    except (UnicodeDecodeError, FormatError) as error:
        raise from_kind("format", f"cannot use {path}: {error}") from error
    if result.config != json.loads(json.dumps(experiment.config())):
        raise from_kind("format", f"{path} is of another config; reproduce it again")
    return result


def saved_ids(folder: Path, ids: Iterable[str]) -> list[str]:
    """Return those of some experiments that have a result in a folder."""
    return [identifier for identifier in ids if _result(folder, identifier).exists()]


def _result(folder: Path, identifier: str) -> Path:
    return folder / f"{identifier}.json"


def _games(folder: Path, identifier: str) -> Path:
    return folder / f"{identifier}.games.json"
