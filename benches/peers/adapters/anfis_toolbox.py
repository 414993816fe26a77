"""anfis-toolbox: NumPy, ANFIS alone; its systems of order 0 are of order 1 with zeros."""

from anfis_toolbox.membership import GaussianMF
from anfis_toolbox.model import TSKANFIS
from anfis_toolbox.optim import HybridTrainer
from works import Trainer, Training


def anfis(work: Training) -> list[Trainer]:
    def train(epochs):
        terms = {name: [GaussianMF(mean, work.sigma) for mean in work.means] for name in ("x", "y")}
        trainer = HybridTrainer(learning_rate=work.rate, epochs=epochs)
        model = TSKANFIS(terms)
        model.fit(work.points, work.targets, trainer=trainer)
        return model.predict(work.points).ravel()

    return [Trainer("anfis-toolbox", train)]
