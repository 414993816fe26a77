//! Any text is a system or an error; a system is the same when it is written and read again.

#![no_main]

use fuzzy_core::Tsk;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let Ok(system) = Tsk::from_json(text) else { return };
    let text = system.to_json().expect("a system that was read can be written");
    assert_eq!(Tsk::from_json(&text).expect("what was written can be read"), system);
});
