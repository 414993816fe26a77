//! The controllers of all robots bred at once, each by a genetic search of its own.

use std::array::from_fn;

use fuzzy_core::learn::genetic::Genetic;
use fuzzy_core::{Control, Rng, check};

use super::chromosome::{GENES, express, template};
use super::temporal::{EVADER, PURSUER};
use super::{Role, check_starts};
use crate::error::Result;
use crate::game::one_on_one::{OneOnOne, Start};
use crate::rollout::{Entrant, Outcome, play_population};
use crate::strategy::{Controller, FuzzyController};

/// Whom an individual meets when all robots' controllers are bred. The thesis does not say.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pairing {
    /// The best of the other robots' last generations: each robot's individuals have games of
    /// their own.
    Best,
    /// The individuals in the same place of the other robots' populations.
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

/// A game in which controllers of N robots are bred.
pub(super) trait Arena<const N: usize> {
    /// Where a game begins.
    type Start;

    /// What the robots want: pursuers short games, evaders long ones.
    const ROLES: [Role; N];

    /// The robots' controllers, whose parameters are bred.
    fn templates(&self) -> Result<[FuzzyController; N]>;

    /// Nothing, or what does not fit.
    fn check(&self) -> Result<()>;

    /// Draws where a game begins.
    fn draw(&self, rng: &mut Rng) -> Self::Start;

    /// The games of a population, as in [`play_population`].
    fn play(
        &self,
        entrants: [Entrant<'_>; N],
        starts: &[Self::Start],
        steps: u32,
        control: &Control,
    ) -> Result<Vec<Outcome>>;

    /// The time step (s).
    fn time_step(&self) -> f64;
}

/// One pursuer and one evader, which starts from one of these positions.
pub(super) struct Pursuit<'a> {
    pub game: &'a OneOnOne,
    pub starts: &'a [(f64, f64)],
}

impl Arena<2> for Pursuit<'_> {
    type Start = Start;

    const ROLES: [Role; 2] = [Role::Pursuer, Role::Evader];

    fn templates(&self) -> Result<[FuzzyController; 2]> {
        Ok([template(PURSUER)?, template(EVADER)?])
    }

    fn check(&self) -> Result<()> {
        check_starts(self.starts)
    }

    fn draw(&self, rng: &mut Rng) -> Start {
        let (x, y) = self.starts[rng.below(self.starts.len())];
        Start::evader_at(x, y)
    }

    fn play(
        &self,
        [pursuer, evader]: [Entrant<'_>; 2],
        starts: &[Start],
        steps: u32,
        control: &Control,
    ) -> Result<Vec<Outcome>> {
        play_population(self.game, pursuer, evader, starts, steps, control)
    }

    fn time_step(&self) -> f64 {
        self.game.time_step()
    }
}

/// The games of a generation: all individuals play from the same starts.
pub(super) struct Games<A, const N: usize> {
    pub arena: A,
    /// How many starts are drawn for a generation. An individual's loss is the mean over them.
    pub starts: u32,
    /// Time steps after which a game is given up.
    pub steps: u32,
    pub rng: Rng,
}

impl<A: Arena<N>, const N: usize> Games<A, N> {
    /// Nothing, or what does not fit.
    pub fn check(&self) -> Result<()> {
        check::at_least("steps", self.steps as usize, 1)?;
        check::within(
            "starts of a generation",
            f64::from(self.starts),
            "between 1 and 10000",
            |starts| (1.0..=1e4).contains(&starts),
        )?;
        self.arena.check()
    }

    /// Draws the starts of a generation.
    pub fn draw(&mut self) -> Vec<A::Start> {
        (0..self.starts).map(|_| self.arena.draw(&mut self.rng)).collect()
    }

    /// The loss of each individual in games from these starts, and the time steps played.
    pub fn play(
        &self,
        entrants: [Entrant<'_>; N],
        starts: &[A::Start],
        control: &Control,
        loss: impl Fn(&Outcome) -> f64,
    ) -> Result<(Vec<f64>, u64)> {
        let outcomes = self.arena.play(entrants, starts, self.steps, control)?;
        let individuals = outcomes.len() / starts.len();
        let mean = |individual| {
            let own = outcomes.iter().skip(individual).step_by(individuals);
            own.map(&loss).sum::<f64>() / starts.len() as f64
        };
        let played = outcomes.iter().map(|outcome| u64::from(outcome.steps)).sum();
        Ok(((0..individuals).map(mean).collect(), played))
    }
}

/// Searches whose individuals play each other.
pub(super) struct Coevolution<A, const N: usize> {
    pub games: Games<A, N>,
    pub pairing: Pairing,
}

/// What [`Coevolution::run`] found, robot by robot.
pub(super) struct Bred<const N: usize> {
    pub controllers: [Controller; N],
    pub learning_time: f64,
    /// What the best individual of each generation reached.
    pub history: [Vec<f64>; N],
}

impl<A: Arena<N>, const N: usize> Coevolution<A, N> {
    /// Nothing, or what does not fit.
    pub fn check(&self, searches: [&Genetic; N]) -> Result<()> {
        self.games.check()?;
        if self.pairing == Pairing::Place {
            let sizes = searches.map(|search| search.settings().population);
            for (template, size) in self.games.arena.templates()?.iter().zip(sizes) {
                let who = template.system().name();
                let what = format!("population of the {who}, which meets others place by place");
                check::same_length(&what, sizes[0], size)?;
            }
        }
        Ok(())
    }

    /// Runs the searches. `loss` is what pursuers want to be small and evaders large. As with one
    /// search, the best of the last generation are returned.
    pub fn run(
        mut self,
        mut searches: [Genetic; N],
        iterations: u32,
        control: &Control,
        loss: impl Fn(&Outcome) -> f64,
    ) -> Result<Bred<N>> {
        let templates = self.games.arena.templates()?;
        let signs = A::ROLES.map(|role| match role {
            Role::Pursuer => 1.0,
            Role::Evader => -1.0,
        });
        let mut played = 0;
        for _ in 0..iterations {
            let (losses, steps) = self.generation(&searches, &templates, control, &loss)?;
            for ((search, losses), sign) in searches.iter_mut().zip(losses).zip(signs) {
                let fitness: Vec<f64> = losses.into_iter().map(|loss| sign * loss).collect();
                search.tell(&fitness)?;
            }
            played += steps;
            control.advance(1)?;
        }
        let best = |i: usize| &searches[i].history().best;
        let mut controllers = [const { Controller::Classical }; N];
        for ((best, search), template) in controllers.iter_mut().zip(&searches).zip(&templates) {
            *best = Controller::Fuzzy(Box::new(template.with_parameters(&leader(search))?));
        }
        Ok(Bred {
            controllers,
            learning_time: played as f64 * self.games.arena.time_step(),
            history: from_fn(|i| best(i).iter().map(|fitness| signs[i] * fitness).collect()),
        })
    }

    /// Lets a generation of all robots play: the losses of each robot's individuals, and the time
    /// steps played.
    fn generation(
        &mut self,
        searches: &[Genetic; N],
        templates: &[FuzzyController; N],
        control: &Control,
        loss: impl Fn(&Outcome) -> f64,
    ) -> Result<([Vec<f64>; N], u64)> {
        let starts = self.games.draw();
        let own = searches.each_ref().map(|search| express(search.population()));
        let sizes = searches.each_ref().map(|search| search.settings().population);
        if self.pairing == Pairing::Place {
            let all = from_fn(|robot| Entrant::Population(&templates[robot], &own[robot]));
            let (losses, played) = self.games.play(all, &starts, control, loss)?;
            return Ok((from_fn(|_| losses.clone()), played));
        }
        // The games of the first robot's individuals with the others' best, then the second's, …:
        // all side by side, so that no lane waits for the last game of a population.
        let best = searches.each_ref().map(leader);
        let lined_up = from_fn::<_, N, _>(|robot| {
            let games_of = |other: usize| match other == robot {
                true => own[robot].clone(),
                false => best[robot].repeat(sizes[other]),
            };
            (0..N).flat_map(games_of).collect::<Vec<_>>()
        });
        let all = from_fn(|robot| Entrant::Population(&templates[robot], &lined_up[robot]));
        let (losses, played) = self.games.play(all, &starts, control, loss)?;
        let mut rest = losses.into_iter();
        Ok((sizes.map(|size| rest.by_ref().take(size).collect()), played))
    }
}

/// The parameters of the best of the generation last told; of the first individual before the
/// first.
fn leader(search: &Genetic) -> Vec<f64> {
    express(search.leader().map_or(&search.population()[..GENES], |leader| &leader.genes))
}
