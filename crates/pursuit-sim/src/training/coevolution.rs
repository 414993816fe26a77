//! Both robots' controllers bred at once, each by a genetic search of its own.

use fuzzy_core::learn::genetic::Genetic;
use fuzzy_core::{Control, Rng, check};

use super::check_starts;
use super::chromosome::{GENES, express, template};
use super::temporal::{EVADER, PURSUER};
use crate::error::Result;
use crate::game::one_on_one::{OneOnOne, Start};
use crate::rollout::{Entrant, Outcome, play_population};
use crate::strategy::{Controller, FuzzyController};

/// Whom an individual meets when both robots' controllers are bred. The thesis does not say.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pairing {
    /// The best of the other robot's last generation: two games for each pair of individuals.
    Best,
    /// The individual in the same place of the other robot's population.
    Place,
}

impl Pairing {
    /// The name that programs use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Best => "best",
            Self::Place => "place",
        }
    }

    /// The pairing with this name.
    pub fn from_name(name: &str) -> Result<Self> {
        Ok(check::named("pairing", name, [Self::Best, Self::Place], Self::name)?)
    }
}

/// Two searches whose individuals play each other: in each generation all from one start.
pub(super) struct Coevolution<'a> {
    pub game: &'a OneOnOne,
    pub starts: &'a [(f64, f64)],
    pub steps: u32,
    pub pairing: Pairing,
    pub rng: Rng,
}

/// What [`Coevolution::run`] found; of the pursuer, then of the evader.
pub(super) struct Bred {
    pub controllers: [Controller; 2],
    pub learning_time: f64,
    /// What the best individual of each generation reached.
    pub history: [Vec<f64>; 2],
}

/// The individuals of one robot in a generation.
struct Generation {
    template: FuzzyController,
    /// Their parameter vectors.
    population: Vec<f64>,
    best: Controller,
}

impl Generation {
    fn of(search: &Genetic, template: &FuzzyController) -> Result<Self> {
        let population = express(search.population());
        let mut best = population[..GENES].to_vec();
        if let Some(leader) = search.leader() {
            best = express(&leader.genes);
        }
        let best = Controller::Fuzzy(Box::new(template.with_parameters(&best)?));
        Ok(Self { template: template.clone(), population, best })
    }

    fn all(&self) -> Entrant<'_> {
        Entrant::Population(&self.template, &self.population)
    }
}

impl Coevolution<'_> {
    /// Nothing, or what does not fit.
    pub fn check(&self, searches: [&Genetic; 2]) -> Result<()> {
        check::at_least("steps", self.steps as usize, 1)?;
        check_starts(self.starts)?;
        if self.pairing == Pairing::Place {
            let [pursuers, evaders] = searches.map(|search| search.settings().population);
            check::same_length(
                "population of evaders that meet place by place",
                pursuers,
                evaders,
            )?;
        }
        Ok(())
    }

    /// Runs both searches. `loss` is what the pursuer wants to be small and the evader large. As
    /// with one search, the best of the last generation are returned.
    pub fn run(
        mut self,
        mut searches: [Genetic; 2],
        iterations: u32,
        control: &Control,
        loss: impl Fn(&Outcome) -> f64,
    ) -> Result<Bred> {
        let templates = [template(PURSUER)?, template(EVADER)?];
        let generations = |searches: &[Genetic; 2]| -> Result<[Generation; 2]> {
            let [pursuers, evaders] = searches;
            Ok([Generation::of(pursuers, &templates[0])?, Generation::of(evaders, &templates[1])?])
        };
        let mut played: u64 = 0;
        for _ in 0..iterations {
            let outcomes = self.play(&generations(&searches)?, control)?;
            played += outcomes.games.iter().map(|outcome| u64::from(outcome.steps)).sum::<u64>();
            let losses: Vec<f64> = outcomes.games.iter().map(&loss).collect();
            searches[0].tell(&losses[..outcomes.pursuers])?;
            let gains: Vec<f64> = losses[outcomes.evaders..].iter().map(|loss| -loss).collect();
            searches[1].tell(&gains)?;
            control.advance(1)?;
        }
        let history = [
            searches[0].history().best.clone(),
            searches[1].history().best.iter().map(|gain| -gain).collect(),
        ];
        let controllers = generations(&searches)?.map(|generation| generation.best);
        Ok(Bred { controllers, learning_time: played as f64 * self.game.time_step(), history })
    }

    /// Lets a generation of both robots play from one start.
    fn play(&mut self, generations: &[Generation; 2], control: &Control) -> Result<Games> {
        let (x, y) = self.starts[self.rng.below(self.starts.len())];
        let start = Start::evader_at(x, y);
        let play = |pursuer, evader| {
            play_population(self.game, pursuer, evader, &[start], self.steps, control)
        };
        let [pursuers, evaders] = generations;
        Ok(match self.pairing {
            Pairing::Place => {
                let games = play(pursuers.all(), evaders.all())?;
                Games { pursuers: games.len(), evaders: 0, games }
            }
            Pairing::Best => {
                let mut games = play(pursuers.all(), Entrant::Same(&evaders.best))?;
                let count = games.len();
                games.extend(play(Entrant::Same(&pursuers.best), evaders.all())?);
                Games { pursuers: count, evaders: count, games }
            }
        })
    }
}

/// The games of a generation.
struct Games {
    games: Vec<Outcome>,
    /// So many from the first on count for the pursuers.
    pursuers: usize,
    /// Those from here on count for the evaders.
    evaders: usize,
}
