//! The Python face of fuzzyrs: conversions, and one door between the two languages.
//!
//! No formula and no loop over samples lives here. A binding converts what came, goes through
//! `enter`, and converts the result or the error.

mod agents;
mod anfis;
mod arrays;
mod control;
mod controllers;
mod definition;
mod enter;
mod errors;
mod evaluate;
mod games;
mod genetic;
mod insight;
mod mdp;
mod membership;
mod operators;
mod outcomes;
mod output;
mod pickle;
mod practice;
mod q_lambda;
mod regulators;
mod rules;
mod schedule;
mod settings;
mod shapes;
mod strategies;
mod systems;
mod tabular;
mod training;
mod tsk;
mod two_pursuers;
mod wall;

use pyo3::prelude::*;

#[pymodule]
fn _fuzzyrs(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("ERROR_KINDS", errors::kinds())?;
    module.add_class::<control::PyControl>()?;
    module.add_class::<membership::PyMembershipFunction>()?;
    module.add_class::<membership::PyVariable>()?;
    module.add_class::<rules::PyProposition>()?;
    module.add_class::<rules::PyRule>()?;
    module.add_class::<output::PyOutput>()?;
    module.add_class::<systems::PySystem>()?;
    module.add_class::<tsk::PyTsk>()?;
    module.add_class::<insight::PyExplanation>()?;
    module.add_class::<insight::PyFinding>()?;
    module.add_class::<operators::PyGene>()?;
    module.add_class::<operators::PySelection>()?;
    module.add_class::<operators::PyCrossover>()?;
    module.add_class::<operators::PyMutation>()?;
    module.add_class::<genetic::PyGenetic>()?;
    module.add_class::<anfis::PyAnfisFit>()?;
    module.add_class::<anfis::PyOnlineAnfis>()?;
    module.add_class::<anfis::PyRecursiveLeastSquares>()?;
    module.add_class::<q_lambda::PyDiscretiser>()?;
    module.add_class::<q_lambda::PyQLambda>()?;
    module.add_class::<schedule::PySchedule>()?;
    module.add_class::<agents::PyQlfis>()?;
    module.add_class::<agents::PyFuzzyActorCritic>()?;
    module.add_class::<agents::PyNeuralActorCritic>()?;
    module.add_class::<agents::PyQLambdaAgent>()?;
    module.add_class::<tabular::PyActorCritic>()?;
    module.add_class::<tabular::PyModelBuilding>()?;
    module.add_class::<mdp::PyMdp>()?;
    module.add_class::<mdp::PyMdpWalk>()?;
    module.add_class::<mdp::PyMdpTrial>()?;
    module.add_class::<games::PyVehicle>()?;
    module.add_class::<controllers::PyFuzzyController>()?;
    module.add_class::<controllers::PyTableController>()?;
    module.add_class::<strategies::PyPd>()?;
    module.add_class::<strategies::PyEvasiveTurn>()?;
    module.add_class::<strategies::PyParallel>()?;
    module.add_class::<games::PyOneOnOne>()?;
    module.add_class::<two_pursuers::PyTwoPursuers>()?;
    module.add_class::<two_pursuers::PyTwoPursuersTrajectory>()?;
    module.add_class::<two_pursuers::PyTwoPursuersTrained>()?;
    module.add_class::<practice::PyPractice>()?;
    module.add_class::<outcomes::PyTrajectory>()?;
    module.add_class::<outcomes::PyOutcomes>()?;
    module.add_class::<settings::PyGeneticPhase>()?;
    module.add_class::<settings::PyGeneRanges>()?;
    module.add_class::<settings::PyQLambdaTraining>()?;
    module.add_class::<settings::PyRewardGaTraining>()?;
    module.add_class::<settings::PyQlbgflcTraining>()?;
    module.add_class::<settings::PyQlfisTraining>()?;
    module.add_class::<settings::PyDaiTraining>()?;
    module.add_class::<settings::PyLessons>()?;
    module.add_class::<settings::PyIanfisTraining>()?;
    module.add_class::<settings::PyIgbflcTraining>()?;
    module.add_class::<settings::PyTwoPursuersQLambdaTraining>()?;
    module.add_class::<settings::PyTwoPursuersQlbgflcTraining>()?;
    module.add_class::<settings::PyWallGeneRanges>()?;
    module.add_class::<settings::PyWallIgbflcTraining>()?;
    module.add_class::<training::PyTrained>()?;
    module.add_class::<regulators::PyFuzzyRegulator>()?;
    module.add_class::<wall::PyWall>()?;
    module.add_class::<wall::PyWallFollowing>()?;
    module.add_class::<wall::PyWallRun>()?;
    module.add_class::<wall::PyWallStage>()?;
    module.add_class::<wall::PyWallTrained>()?;
    module.add_function(wrap_pyfunction!(rules::rule_table, module)?)?;
    shapes::add_to(module)?;
    module.add_function(wrap_pyfunction!(controllers::load, module)?)?;
    module.add_function(wrap_pyfunction!(tsk::write_text, module)?)?;
    module.add_function(wrap_pyfunction!(anfis::fit_anfis, module)?)?;
    module.add_function(wrap_pyfunction!(genetic::fit_genetic, module)?)?;
    module.add_function(wrap_pyfunction!(mdp::learn_mdp, module)?)?;
    module.add_function(wrap_pyfunction!(training::train, module)?)?;
    Ok(())
}
