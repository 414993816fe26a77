//! Who steers the robots in the games of a population.

use fuzzy_core::check;
use fuzzy_core::math::Lanes;

use crate::error::Result;
use crate::strategy::{Controller, FuzzyController, Player};

/// Who steers a robot in the games of a population.
#[derive(Debug, Clone, Copy)]
pub enum Entrant<'a> {
    /// The same controller in every game.
    Same(&'a Controller),
    /// In each game another individual: parameter vectors of the controller's system, one after
    /// the other. They are not checked: they come from a search that keeps to its bounds.
    Population(&'a FuzzyController, &'a [f64]),
}

impl<'a> Entrant<'a> {
    pub(super) fn player(&self) -> Player<'a, Lanes> {
        match self {
            Self::Same(controller) => Player::new(controller),
            Self::Population(controller, _) => Player::fuzzy(controller),
        }
    }
}

/// The prepared numbers of the individuals of every robot.
pub(super) struct Individuals<const N: usize> {
    /// None of a robot whose controller stays.
    numbers: [Vec<Vec<f64>>; N],
    /// How many individuals a population has.
    count: usize,
}

impl<const N: usize> Individuals<N> {
    /// Those of these entrants; robots that have a population must have one of the same size.
    pub fn of(entrants: &[Entrant<'_>; N]) -> Result<Self> {
        let mut numbers = [const { Vec::new() }; N];
        let mut count = None;
        for (own, entrant) in numbers.iter_mut().zip(entrants) {
            let Entrant::Population(controller, population) = entrant else { continue };
            let grid = controller.system().grid();
            let prepare = |individual| {
                let mut prepared = vec![0.0; grid.prepared_count()];
                grid.prepare(individual, &mut prepared);
                prepared
            };
            *own = population.chunks_exact(grid.parameter_count()).map(prepare).collect();
            let first = *count.get_or_insert(own.len());
            check::same_length("individuals of another population", first, own.len())?;
        }
        Ok(Self { numbers, count: count.unwrap_or(0) })
    }

    /// How many games they play from so many starts.
    pub fn games(&self, starts: usize) -> usize {
        self.count * starts
    }

    /// From which start a game is played, and with which individuals' numbers: all games from the
    /// first start come first.
    pub fn game(&self, game: usize) -> (usize, [Option<&[f64]>; N]) {
        let numbers = self.numbers.each_ref();
        let own = numbers.map(|own| own.get(game % self.count).map(Vec::as_slice));
        (game / self.count, own)
    }
}
