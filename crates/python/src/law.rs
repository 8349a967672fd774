//! A Python function as the friction law.

use creepage::OwnLaw;
use numpy::{PyArray1, PyReadonlyArray1, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

/// A function of slip velocities (m/s) that gives as many coefficients of friction.
#[derive(Debug)]
pub struct PythonLaw {
    function: Py<PyAny>,
    /// The coefficient at rest: what a law that failed gives.
    at_rest: f64,
    failed: AtomicBool,
    failure: Mutex<Option<PyErr>>,
}

impl PythonLaw {
    /// The law of a `function` that [`check_law`] found to be one.
    pub fn new(py: Python<'_>, function: Py<PyAny>) -> PyResult<Self> {
        let mut at_rest = [0.0];
        ask(function.bind(py), &[0.0], &mut at_rest)?;
        let [at_rest] = at_rest;
        Ok(Self { function, at_rest, failed: AtomicBool::new(false), failure: Mutex::new(None) })
    }

    /// The exception with which the function ended, once.
    pub fn take_failure(&self) -> Option<PyErr> {
        self.failure.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}

impl OwnLaw for PythonLaw {
    fn mu(&self, slip_speeds: &[f64], mu: &mut [f64]) {
        if self.failed.load(Ordering::Acquire) {
            return mu.fill(self.at_rest);
        }
        let asked = Python::attach(|py| ask(self.function.bind(py), slip_speeds, mu));
        if let Err(error) = asked {
            mu.fill(self.at_rest);
            let mut failure = self.failure.lock().unwrap_or_else(PoisonError::into_inner);
            failure.get_or_insert(error);
            self.failed.store(true, Ordering::Release);
        }
    }

    fn failure(&self) -> Option<String> {
        if !self.failed.load(Ordering::Acquire) {
            return None;
        }
        let failure = self.failure.lock().unwrap_or_else(PoisonError::into_inner);
        Some(failure.as_ref().map_or_else(String::new, ToString::to_string))
    }
}

/// Puts the coefficients that `function` gives at `slip_speeds` (m/s) into `mu`.
fn ask(function: &Bound<'_, PyAny>, slip_speeds: &[f64], mu: &mut [f64]) -> PyResult<()> {
    let py = function.py();
    let given = function.call1((PyArray1::from_slice(py, slip_speeds),))?;
    let given: PyReadonlyArray1<'_, f64> = match given.extract() {
        Ok(given) => given,
        Err(_) => as_array(&given, slip_speeds.len())?,
    };
    if given.len() != slip_speeds.len() {
        return Err(wrong_shape(&format!("({},)", given.len()), slip_speeds.len()));
    }
    for ((mu, &given), speed) in mu.iter_mut().zip(given.as_array()).zip(slip_speeds) {
        if !(given >= 0.0 && given.is_finite()) {
            return Err(PyValueError::new_err(format!(
                "the friction law gives mu = {given} at the slip velocity {speed} m/s; it must be finite \
                 and at least 0"
            )));
        }
        *mu = given;
    }
    Ok(())
}

/// What is no array of doubles, as one.
fn as_array<'py>(given: &Bound<'py, PyAny>, wanted: usize) -> PyResult<PyReadonlyArray1<'py, f64>> {
    let py = given.py();
    let array = py.import("numpy")?.call_method1("asarray", (given, "f8"))?;
    array.extract().or_else(|_| {
        let shape = array.getattr("shape")?.str()?.to_string();
        Err(wrong_shape(&shape, wanted))
    })
}

fn wrong_shape(shape: &str, wanted: usize) -> PyErr {
    PyValueError::new_err(format!(
        "the friction law gives an array of the shape {shape} for {wanted} slip velocities; it must give one \
         coefficient each, for example numpy.full_like(s, 0.3)"
    ))
}

/// Departure up to which coefficients of the same slip velocity are equal: NumPy may round otherwise where
/// an element stands elsewhere in its array.
const EQUAL: f64 = 1e-12;

/// Tries `function` at rest and at slip velocities from 1e-9 to 1e3 m/s; says what makes it no friction law.
#[pyfunction]
pub fn check_law(py: Python<'_>, function: &Bound<'_, PyAny>) -> PyResult<Option<String>> {
    let decades = (0..=240).map(|i| libm::pow(10f64, -9.0 + f64::from(i) / 20.0));
    let speeds: Vec<f64> = std::iter::once(0.0).chain(decades).collect();
    let give = |speeds: &[f64]| -> PyResult<Vec<f64>> {
        let mut mu = vec![0.0; speeds.len()];
        ask(function, speeds, &mut mu)?;
        Ok(mu)
    };
    let once = match give(&speeds) {
        Err(error) if error.is_instance_of::<PyValueError>(py) => {
            // of this module or the function's own: either says what is wrong
            return Ok(Some(error.value(py).to_string()));
        }
        once => once?,
    };
    let again = give(&speeds)?;
    if let Some(i) = (0..speeds.len()).find(|&i| once[i].to_bits() != again[i].to_bits()) {
        return Ok(Some(format!(
            "the friction law gives mu = {} and then {} at the same slip velocity of {} m/s; it must give the \
             same whenever it is asked",
            once[i], again[i], speeds[i]
        )));
    }
    let backwards: Vec<f64> = speeds.iter().rev().skip(1).copied().collect();
    let mut turned = give(&backwards)?;
    turned.reverse();
    let differs = |(a, b): (&f64, &f64)| (a - b).abs() > EQUAL * a.abs();
    if let Some(i) = once.iter().zip(&turned).position(differs) {
        return Ok(Some(format!(
            "the friction law gives mu = {} at the slip velocity {} m/s in one array and {} in another; a \
             coefficient may depend on its own slip velocity alone",
            once[i], speeds[i], turned[i]
        )));
    }
    Ok(None)
}
