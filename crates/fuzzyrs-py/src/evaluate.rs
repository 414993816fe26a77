//! Calls of fuzzy systems of any kind: one point, arrays, derivatives, many parameter vectors.

use fuzzy_core::Error as CoreError;
use fuzzy_core::inference::{Inference, Wrt};
use numpy::{PyArrayDyn, PyArrayMethods, PyReadwriteArrayDyn, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyFloat, PyInt, PyTuple};

use crate::arrays::{Floats, Shape, array};
use crate::errors::{Error, Result};

/// The most inputs and outputs of a point that are kept on the stack.
const FEW: usize = 8;

/// The options of a call.
pub struct Options<'a, 'py> {
    pub out: Option<&'a Bound<'py, PyAny>>,
    pub previous: Option<&'a Bound<'py, PyAny>>,
    pub threads: usize,
    pub named: Option<&'a Bound<'py, PyDict>>,
}

/// What `system(...)` returns.
pub fn call<'py, S: Inference>(
    system: &S,
    x: &Bound<'py, PyTuple>,
    options: &Options<'_, 'py>,
) -> Result<Bound<'py, PyAny>> {
    let named = match options.named {
        Some(named) if !named.is_empty() => Some(in_order(system, x, named)?),
        _ => None,
    };
    let x = named.as_ref().unwrap_or(x);
    let interface = system.interface();
    let plain = options.out.is_none() && x.len() == interface.inputs().len();
    if plain && let Some(answer) = at_numbers(system, x, options.previous)? {
        return Ok(answer);
    }
    at_arrays(system, x, options)
}

/// The arguments in the order of the inputs, from their names.
fn in_order<'py, S: Inference>(
    system: &S,
    x: &Bound<'py, PyTuple>,
    named: &Bound<'py, PyDict>,
) -> Result<Bound<'py, PyTuple>> {
    let (py, inputs) = (x.py(), system.interface().inputs());
    for (name, _) in named.iter() {
        let name: String = name.extract()?;
        if inputs.iter().all(|input| input.name() != name) {
            let known = inputs.iter().map(|input| input.name());
            return Err(CoreError::unknown_name("input", &name, known).into());
        }
    }
    let mut ordered: Vec<Bound<'py, PyAny>> = x.iter().collect();
    for input in inputs.iter().skip(x.len()) {
        match named.get_item(input.name())? {
            Some(value) => ordered.push(value),
            None => {
                let message = format!("the input \"{}\" is missing", input.name());
                return Err(Error::WrongType(message));
            }
        }
    }
    if ordered.len() != x.len() + named.len() {
        let message = "an input is given both by its place and by its name";
        return Err(Error::WrongType(message.to_owned()));
    }
    Ok(PyTuple::new(py, ordered)?)
}

/// The outputs at a point given by plain numbers; nothing if an argument is something else.
fn at_numbers<'py, S: Inference>(
    system: &S,
    x: &Bound<'py, PyTuple>,
    previous: Option<&Bound<'py, PyAny>>,
) -> Result<Option<Bound<'py, PyAny>>> {
    let (mut few, mut many) = ([0.0; FEW], Vec::new());
    let point = some(&mut few, &mut many, x.len());
    for (number, object) in point.iter_mut().zip(x.iter_borrowed()) {
        if !object.is_instance_of::<PyFloat>() && !object.is_instance_of::<PyInt>() {
            return Ok(None);
        }
        // An integer too large for a float is left to NumPy, whose error says so.
        let Ok(value) = object.extract() else { return Ok(None) };
        *number = value;
    }
    let (mut few, mut many) = ([f64::NAN; FEW], Vec::new());
    let outputs = some(&mut few, &mut many, system.interface().outputs().len());
    put_previous(previous, outputs)?;
    system.evaluate_into(point, outputs)?;
    Ok(Some(match outputs {
        [value] => PyFloat::new(x.py(), *value).into_any(),
        values => array(x.py(), values.to_vec(), &[values.len()])?.into_any(),
    }))
}

fn some<'a>(few: &'a mut [f64; FEW], many: &'a mut Vec<f64>, count: usize) -> &'a mut [f64] {
    match few.get_mut(..count) {
        Some(few) => few,
        None => {
            many.resize(count, f64::NAN);
            many
        }
    }
}

/// Puts the outputs before into the first row.
fn put_previous(previous: Option<&Bound<'_, PyAny>>, row: &mut [f64]) -> Result<()> {
    let Some(previous) = previous.filter(|object| !object.is_none()) else { return Ok(()) };
    let previous = Floats::new(previous, "previous")?;
    let numbers = previous.as_slice()?;
    if numbers.len() != row.len() {
        let expected = format!("{} numbers, one for each output", row.len());
        return Err(CoreError::wrong_shape("previous", expected, numbers.len()).into());
    }
    if let Some(&infinite) = numbers.iter().find(|number| number.is_infinite()) {
        // NaN says that there is no output before.
        return Err(CoreError::NotFinite { what: "previous".to_owned(), value: infinite }.into());
    }
    row.copy_from_slice(numbers);
    Ok(())
}

fn at_arrays<'py, S: Inference>(
    system: &S,
    x: &Bound<'py, PyTuple>,
    options: &Options<'_, 'py>,
) -> Result<Bound<'py, PyAny>> {
    let py = x.py();
    let outputs = system.interface().outputs().len();
    let (points, mut shape) = points(system, x)?;
    let threads = options.threads;
    let rows = points.as_slice()?;
    let single = shape.is_empty();
    if outputs > 1 {
        shape.push(outputs);
    }
    if let Some(out) = options.out {
        if single {
            let expected = "inputs of shape (n,) or one array of shape (n, inputs)";
            return Err(CoreError::wrong_shape("out", expected, "a single point").into());
        }
        let mut target = writable(out, &shape)?;
        let results = target.as_slice_mut().map_err(PyErr::from)?;
        start(options.previous, results, outputs)?;
        py.detach(|| system.evaluate_batch(rows, results, threads))?;
        return Ok(out.clone().into_any());
    }
    let mut results = vec![0.0; rows.len() / system.interface().inputs().len() * outputs];
    start(options.previous, &mut results, outputs)?;
    py.detach(|| system.evaluate_batch(rows, &mut results, threads))?;
    match (single, results.as_slice()) {
        (true, &[value]) => Ok(PyFloat::new(py, value).into_any()),
        _ => Ok(array(py, results, &shape)?.into_any()),
    }
}

/// Makes the first row say what the outputs were before.
fn start(previous: Option<&Bound<'_, PyAny>>, results: &mut [f64], outputs: usize) -> Result<()> {
    let Some(row) = results.get_mut(..outputs) else { return Ok(()) };
    row.fill(f64::NAN);
    put_previous(previous, row)
}

/// The points that the arguments stand for, row by row, and the shape of the result.
fn points<'py, S: Inference>(
    system: &S,
    x: &Bound<'py, PyTuple>,
) -> Result<(Floats<'py>, Vec<usize>)> {
    let (py, inputs) = (x.py(), system.interface().inputs().len());
    let name = system.interface().name();
    match x.len() {
        1 => {
            let points = Floats::new(&x.get_item(0)?, "x")?;
            let shape = match *points.shape() {
                [n, width] if width == inputs => vec![n],
                [width] if width == inputs && inputs > 1 => vec![],
                [n] if inputs == 1 => vec![n],
                [] if inputs == 1 => vec![],
                ref shape => {
                    let expected = format!("{inputs} numbers or shape (n, {inputs})");
                    let what = format!("x for \"{name}\"");
                    return Err(CoreError::wrong_shape(what, expected, Shape(shape)).into());
                }
            };
            Ok((points, shape))
        }
        count if count == inputs => {
            let numpy = py.import("numpy")?;
            let arrays = numpy.call_method1("broadcast_arrays", x).map_err(|error| {
                let expected = "arrays that broadcast against each other";
                CoreError::wrong_shape("the inputs", expected, error.value(py))
            })?;
            let stacked = numpy.call_method1("stack", (arrays, -1))?;
            let points = Floats::new(&stacked, "the inputs")?;
            let shape = points.shape()[..points.shape().len() - 1].to_vec();
            Ok((points, shape))
        }
        count => {
            let what = format!("arguments of \"{name}\"");
            let expected = format!("{inputs}, or one array");
            Err(CoreError::wrong_shape(what, expected, count).into())
        }
    }
}

/// The single point that the arguments stand for.
pub fn point<S: Inference>(
    system: &S,
    x: &Bound<'_, PyTuple>,
    named: Option<&Bound<'_, PyDict>>,
) -> Result<Vec<f64>> {
    let named = match named {
        Some(named) if !named.is_empty() => Some(in_order(system, x, named)?),
        _ => None,
    };
    let (points, _) = points(system, named.as_ref().unwrap_or(x))?;
    let (point, inputs) = (points.as_slice()?, system.interface().inputs().len());
    if point.len() != inputs {
        let what = format!("points for \"{}\"", system.interface().name());
        return Err(CoreError::wrong_shape(what, "a single one", point.len() / inputs).into());
    }
    Ok(point.to_vec())
}

/// The caller's array for results of this shape.
fn writable<'py>(
    out: &Bound<'py, PyAny>,
    shape: &[usize],
) -> Result<PyReadwriteArrayDyn<'py, f64>> {
    let suits =
        |array: &&Bound<'py, PyArrayDyn<f64>>| array.shape() == shape && array.is_c_contiguous();
    let array = out.cast::<PyArrayDyn<f64>>().ok();
    let Some(array) = array.filter(suits) else {
        return Err(Error::WrongType(format!(
            "out must be a contiguous float64 array of {}",
            Shape(shape)
        )));
    };
    array
        .try_readwrite()
        .map_err(|error| Error::WrongType(format!("out cannot be written: {error}")))
}

/// The outputs under many parameter vectors.
pub fn population<'py, S: Inference>(
    system: &S,
    vectors: &Bound<'py, PyAny>,
    x: &Bound<'py, PyAny>,
    out: Option<&Bound<'py, PyAny>>,
    threads: usize,
) -> Result<Bound<'py, PyAny>> {
    let py = vectors.py();
    let vectors = Floats::new(vectors, "parameters")?;
    let vectors = vectors.rows("parameters", system.parameters().len())?;
    let (points, of_points) = points(system, &PyTuple::new(py, [x])?)?;
    let points = points.as_slice()?;
    let outputs = system.interface().outputs().len();
    let mut shape = vec![vectors.len() / system.parameters().len()];
    shape.extend(of_points);
    if outputs > 1 {
        shape.push(outputs);
    }
    let size: usize = shape.iter().product();
    if let Some(out) = out {
        let mut target = writable(out, &shape)?;
        let results = target.as_slice_mut().map_err(PyErr::from)?;
        results.fill(f64::NAN);
        py.detach(|| system.evaluate_population(vectors, points, results, threads))?;
        return Ok(out.clone());
    }
    let mut results = fuzzy_core::check::zeros("the result", 1, size)?;
    results.fill(f64::NAN);
    py.detach(|| system.evaluate_population(vectors, points, &mut results, threads))?;
    Ok(array(py, results, &shape)?.into_any())
}

/// What derivatives are wanted.
pub fn wrt(name: &str) -> Result<Wrt> {
    match name {
        "inputs" => Ok(Wrt::Inputs),
        "parameters" => Ok(Wrt::Parameters),
        _ => Err(CoreError::unknown_name("wrt", name, ["inputs", "parameters"]).into()),
    }
}

/// The derivatives of every output at one point or at many.
pub fn gradient<'py, S: Inference>(
    system: &S,
    x: &Bound<'py, PyAny>,
    wrt: Wrt,
    threads: usize,
) -> Result<Bound<'py, PyArrayDyn<f64>>> {
    let (py, outputs, width) = (x.py(), system.interface().outputs().len(), wrt.count(system));
    let points = Floats::new(x, "x")?;
    let single = points.shape().len() < 2;
    let inputs = system.interface().inputs().len();
    let rows = if single { points.as_slice()? } else { points.rows("x", inputs)? };
    let count = rows.len() / inputs;
    let mut shape = if single { vec![] } else { vec![count] };
    if outputs > 1 {
        shape.push(outputs);
    }
    shape.push(width);
    if single {
        let mut derivatives = vec![0.0; outputs * width];
        system.jacobian(wrt, rows, &mut derivatives)?;
        return array(py, derivatives, &shape);
    }
    let mut derivatives = fuzzy_core::check::zeros("the derivatives", count, outputs * width)?;
    py.detach(|| system.jacobian_batch(wrt, rows, &mut derivatives, threads))?;
    array(py, derivatives, &shape)
}
