//! Polling a device later, in browsers.

use std::sync::{Arc, Mutex, PoisonError};

use js_sys::{Function, Reflect};
use wasm_bindgen::closure::Closure;
use wasm_bindgen::{JsCast as _, JsValue};

use super::map_status::MapStatus;

/// Wakes the task that waits for a buffer in a later turn of the event loop: with `setTimeout`, which windows and workers have.
pub fn later(arrival: &Arc<Mutex<MapStatus>>) {
    let arrival = arrival.clone();
    let wake = Closure::once_into_js(move || {
        let waiting = arrival.lock().unwrap_or_else(PoisonError::into_inner).waiting();
        if let Some(task) = waiting {
            task.wake();
        }
    });
    let set_timeout = Reflect::get(&js_sys::global(), &"setTimeout".into());
    let set_timeout = set_timeout.ok().and_then(|f| f.dyn_into::<Function>().ok());
    if let Some(set_timeout) = set_timeout {
        // without a timer, an event of the device may still bring the buffer
        let _ = set_timeout.call2(&JsValue::UNDEFINED, &wake, &JsValue::from(1));
    }
}
