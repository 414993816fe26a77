"""What one writes with numba: plain loops, memberships once for each input."""

import math

import numba
import numpy as np
from works import Contender, Mamdani, Sampling, Tsk


def tsk(work: Tsk) -> list[Contender]:
    x, y, table = np.array(work.x), np.array(work.y), np.array(work.constants)

    @numba.njit
    def point(first, second):
        total = weighted = 0.0
        degrees = np.empty(len(y))
        for j in range(len(y)):
            degrees[j] = math.exp(-0.5 * ((second - y[j, 0]) / y[j, 1]) ** 2)
        for i in range(len(x)):
            degree = math.exp(-0.5 * ((first - x[i, 0]) / x[i, 1]) ** 2)
            for j in range(len(y)):
                total += degree * degrees[j]
                weighted += degree * degrees[j] * table[i, j]
        return weighted / total

    return [_contender(point, None)]


def mamdani(work: Mamdani) -> list[Contender]:
    x, y, z, table = np.array(work.x), np.array(work.y), np.array(work.z), np.array(work.table)
    sampling = Sampling.endpoints()
    positions = sampling.positions

    @numba.njit
    def trapezoid(value, term):
        if value < term[1]:
            return 0.0 if value < term[0] else (value - term[0]) / (term[1] - term[0])
        if value > term[2]:
            return 0.0 if value > term[3] else (term[3] - value) / (term[3] - term[2])
        return 1.0

    sets = np.array([[trapezoid(position, term) for term in z] for position in positions])

    @numba.njit
    def point(first, second):
        strengths, degrees = np.zeros(len(z)), np.empty(len(y))
        for j in range(len(y)):
            degrees[j] = trapezoid(second, y[j])
        for i in range(len(x)):
            degree = trapezoid(first, x[i])
            for j in range(len(y)):
                k = table[i, j]
                strengths[k] = max(strengths[k], min(degree, degrees[j]))
        moment = area = 0.0
        for sample in range(len(positions)):
            degree = 0.0
            for k in range(len(z)):
                degree = max(degree, min(strengths[k], sets[sample, k]))
            moment += degree * positions[sample]
            area += degree
        return moment / area

    return [_contender(point, sampling)]


def _contender(point, sampling):
    @numba.njit
    def rows(points, outputs):
        for row in range(len(points)):
            outputs[row] = point(points[row, 0], points[row, 1])

    def calls(points):
        return [point(x, y) for x, y in points]

    def batch(points):
        outputs = np.empty(len(points))
        rows(points, outputs)
        return outputs

    return Contender("numba by hand", calls, batch, sampling)
