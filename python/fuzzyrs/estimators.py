"""scikit-learn's interface to the learners. It needs scikit-learn: `pip install "fuzzyrs[sklearn]"`."""

from __future__ import annotations

from itertools import product
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from sklearn.base import BaseEstimator, RegressorMixin  # type: ignore[import-untyped]
from sklearn.utils import check_random_state  # type: ignore[import-untyped]
from sklearn.utils.validation import (  # type: ignore[import-untyped]
    check_is_fitted,
    validate_data,
)

from fuzzyrs._fuzzyrs import TSK, OnlineAnfis, Output, System, Variable, fit_anfis

__all__ = ["ANFISRegressor"]

_Floats = NDArray[np.float64]


class ANFISRegressor(RegressorMixin, BaseEstimator):  # type: ignore[misc]
    """Regression by a fuzzy system whose rules and membership functions are fitted (ANFIS).

    Parameters
    ----------
    system : TSK or System, optional
        Where the training begins. By default a grid of rules over evenly spread terms, on universes
        from the least to the largest value of each column, to whose ends inputs beyond are brought.
    terms : int, optional
        The terms of an input.
    shape : str, optional
        The shape of the terms, one that makes an even partition.
    order : {0, 1}, optional
        Whether rules conclude constants or linear functions of the inputs.
    max_rules : int, optional
        Inputs get terms while the rules are no more than this, those first whose correlation with
        a target is largest; the others come into linear conclusions only.
    epochs, solver, ridge, premise, rate, patience : optional
        As for `fit_anfis`.
    validation_fraction : float, optional
        The share of the samples that decide which epoch is the best; None for none.
    forgetting, covariance : float, optional
        As for `OnlineAnfis`; for `partial_fit`.
    random_state : int, RandomState instance or None, optional
        Draws the validation samples and the order of "shuffled" steps.

    Attributes
    ----------
    system_ : TSK or System
        The fitted system; a System if there are several targets.
    history_ : dict of numpy.ndarray
        The errors of each epoch, as `AnfisFit.history` has them.
    best_epoch_, n_iter_ : int
        The number of the best epoch from 0, and how many epochs there were.
    n_features_in_ : int
        The number of inputs.

    Examples
    --------
    >>> import numpy as np
    >>> from fuzzyrs.estimators import ANFISRegressor
    >>> X = np.random.default_rng(0).uniform(-3, 3, (200, 2))
    >>> y = np.sin(X[:, 0]) * X[:, 1]
    >>> bool(ANFISRegressor(terms=4).fit(X, y).score(X, y) > 0.99)
    True
    """

    def __init__(
        self,
        system: TSK | System | None = None,
        *,
        terms: int = 3,
        shape: str = "gaussian",
        order: Literal[0, 1] = 1,
        max_rules: int = 32,
        epochs: int = 10,
        solver: Literal["cholesky", "orthogonal"] = "cholesky",
        ridge: float = 1e-6,
        premise: str = "normalised",
        rate: float = 0.01,
        patience: int | None = None,
        validation_fraction: float | None = None,
        forgetting: float = 1.0,
        covariance: float = 1e6,
        random_state: Any = None,
    ) -> None:
        self.system = system
        self.terms = terms
        self.shape = shape
        self.order = order
        self.max_rules = max_rules
        self.epochs = epochs
        self.solver = solver
        self.ridge = ridge
        self.premise = premise
        self.rate = rate
        self.patience = patience
        self.validation_fraction = validation_fraction
        self.forgetting = forgetting
        self.covariance = covariance
        self.random_state = random_state

    def fit(self, X: ArrayLike, y: ArrayLike) -> ANFISRegressor:  # noqa: N803
        """Fit the system to samples.

        Parameters
        ----------
        X : array_like of shape (n, inputs)
            The samples' inputs.
        y : array_like of shape (n,) or (n, outputs)
            The wanted outputs.

        Returns
        -------
        ANFISRegressor
            This one.
        """
        points, targets = validate_data(self, X, y, dtype=np.float64, **_TARGETS)
        targets = np.asarray(targets, dtype=np.float64)
        random = check_random_state(self.random_state)
        training, validation = self._split(points, targets, random)
        start = self.system or self._grid(points, targets)
        fit = fit_anfis(
            start,
            *training,
            epochs=self.epochs,
            solver=self.solver,
            ridge=self.ridge,
            premise=self.premise,  # type: ignore[arg-type]
            rate=self.rate,
            validation=validation,
            patience=self.patience,
            seed=int(random.randint(2**31)),
        )
        self.system_ = fit.system
        self.history_ = fit.history
        self.best_epoch_ = fit.best_epoch
        self.n_iter_ = len(fit.history["training"])
        self._online = None
        self._one_target = targets.ndim == 1
        return self

    def partial_fit(self, X: ArrayLike, y: ArrayLike) -> ANFISRegressor:  # noqa: N803
        """Follow a stream: the consequents by recursive least squares, the terms as they are.

        The first call makes the system from its samples, if neither `fit` nor `system` did.

        Parameters
        ----------
        X : array_like of shape (n, inputs)
            The inputs of the next samples.
        y : array_like of shape (n,) or (n, outputs)
            The wanted outputs.

        Returns
        -------
        ANFISRegressor
            This one.
        """
        first = not hasattr(self, "system_")
        points, targets = validate_data(self, X, y, dtype=np.float64, reset=first, **_TARGETS)
        targets = np.asarray(targets, dtype=np.float64)
        if first:
            self.system_ = self.system or self._grid(points, targets)
            self._one_target = targets.ndim == 1
            self._online = None
        if self._online is None:
            options = {"forgetting": self.forgetting, "covariance": self.covariance}
            self._online = OnlineAnfis(self.system_, **options)
        self._online.learn(points, targets)
        self.system_ = self._online.system
        return self

    def predict(self, X: ArrayLike) -> _Floats:  # noqa: N803
        """Return the outputs at the rows of X, of shape (n,) or (n, outputs).

        Parameters
        ----------
        X : array_like of shape (n, inputs)
            The inputs.
        """
        check_is_fitted(self, "system_")
        points = validate_data(self, X, dtype=np.float64, reset=False)
        outputs = np.asarray(self.system_(points), dtype=np.float64)
        return (
            outputs.reshape(len(points)) if self._one_target else outputs.reshape(len(points), -1)
        )

    def __sklearn_is_fitted__(self) -> bool:
        return hasattr(self, "system_")

    def __sklearn_tags__(self) -> Any:
        tags = super().__sklearn_tags__()
        tags.target_tags.multi_output = True
        return tags

    def _split(self, points: _Floats, targets: _Floats, random: Any) -> tuple[Any, Any]:
        """Return the samples to train with and those to validate with, each a pair, or None."""
        if self.validation_fraction is None:
            return (points, targets), None
        if not 0 < self.validation_fraction < 1:
            raise ValueError(
                f"validation_fraction must lie between 0 and 1, got {self.validation_fraction}"
            )
        order = random.permutation(len(points))
        count = max(1, round(self.validation_fraction * len(points)))
        if count >= len(points):
            raise ValueError(
                f"n_samples={len(points)} are too few to set some aside for validation"
            )
        aside, rest = order[:count], order[count:]
        return (points[rest], targets[rest]), (points[aside], targets[aside])

    def _grid(self, points: _Floats, targets: _Floats) -> TSK | System:
        """Make a system of all combinations of terms that concludes zero."""
        counts = self._counts(points, targets.reshape(len(points), -1))
        columns = zip(points.T, counts, strict=True)
        inputs = [self._variable(f"x{k}", *column) for k, column in enumerate(columns)]
        size = 1 + (points.shape[1] if self.order else 0)
        if targets.ndim == 1:
            consequents = np.zeros((*counts, *[size][: self.order]))
            return TSK(inputs, consequents, order=self.order, outside="clamp")
        return _rules(inputs, targets.shape[1], size)

    def _counts(self, points: _Floats, targets: _Floats) -> list[int]:
        """Return the number of terms of each input."""
        spread = points - points.mean(axis=0), targets - targets.mean(axis=0)
        sizes = [np.linalg.norm(each, axis=0) for each in spread]
        scale = np.outer(*sizes)
        together = np.abs(spread[0].T @ spread[1])
        correlation = np.divide(together, scale, out=np.zeros_like(together), where=scale > 0)
        counts = [1] * points.shape[1]
        rules = 1
        for column in np.argsort(-correlation.max(axis=1), kind="stable"):
            if rules * self.terms <= self.max_rules:
                counts[column] = self.terms
                rules *= self.terms
        return counts

    def _variable(self, name: str, column: _Floats, count: int) -> Variable:
        """Return an input over the range of a column; one term of many is wide enough for all."""
        low, high = float(column.min()), float(column.max())
        if not high > low:
            margin = 0.5 * max(abs(low), 1.0)
            low, high = low - margin, high + margin
        names = [f"t{index}" for index in range(max(count, 2))]
        variable = Variable.evenly(name, (low, high), names, self.shape)  # type: ignore[arg-type]
        if count > 1:
            return variable
        wide = Variable.evenly(name, (low - (high - low), high), names, self.shape)  # type: ignore[arg-type]
        return Variable(name, (low, high), {"all": list(wide.terms.values())[-1]})


_TARGETS = {"multi_output": True, "y_numeric": True}


def _rules(inputs: list[Variable], outputs: int, size: int) -> System:
    """Make a System of all combinations of terms with several Sugeno outputs that are zero."""
    each = list(product(*(variable.terms for variable in inputs)))
    zero: Any = [0.0] * size if size > 1 else 0.0
    concluded = [
        Output.sugeno(f"y{k}", {f"r{rule}": zero for rule in range(len(each))})
        for k in range(outputs)
    ]
    rules = []
    for rule, terms in enumerate(each):
        pairs = zip(inputs, terms, strict=True)
        condition = " and ".join(f"{variable.name} is {term}" for variable, term in pairs)
        conclusion = " and ".join(f"y{k} is r{rule}" for k in range(outputs))
        rules.append(f"if {condition} then {conclusion}")
    return System(inputs, concluded, rules, conjunction="product", outside="clamp")
