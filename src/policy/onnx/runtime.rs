//! Calls into the runtime, which panics on some models and traverses graphs recursively.

use std::any::Any;
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Once;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Graphs with more operators are planned on a separate stack.
pub(super) const SHALLOW: usize = 1000;
/// Maximum number of operators of a graph: [`STACK`] suffices for a chain of them, with a factor of four to spare in a release build.
pub(super) const MOST: usize = if cfg!(target_arch = "wasm32") { SHALLOW } else { 10_000 };
/// Bytes of the stack for large graphs.
const STACK: usize = 64 << 20;

thread_local! {
    /// Whether this thread is inside the runtime.
    static INSIDE: Cell<bool> = const { Cell::new(false) };
}
/// Number of calls in progress in the process.
static CALLS: AtomicUsize = AtomicUsize::new(0);

/// Calls the runtime for a model whose largest graph has `operators` operators. The message of a panic becomes the error and is not
/// printed.
pub(super) fn call<T: Send>(operators: usize, work: impl FnOnce() -> T + Send) -> Result<T, String> {
    let guarded = move || {
        CALLS.fetch_add(1, Ordering::Relaxed);
        INSIDE.set(true);
        let done = catch_unwind(AssertUnwindSafe(work));
        INSIDE.set(false);
        CALLS.fetch_sub(1, Ordering::Relaxed);
        done
    };
    let gave_up = |cause: Box<dyn Any + Send>| {
        let said = cause.downcast_ref::<String>().map(String::as_str);
        let said = said.or_else(|| cause.downcast_ref::<&str>().copied());
        format!("the runtime gave up on it: {}", said.unwrap_or("it does not say why"))
    };
    silence();
    if operators <= SHALLOW || cfg!(target_arch = "wasm32") {
        return guarded().map_err(gave_up);
    }
    std::thread::scope(|scope| {
        let deep = std::thread::Builder::new().stack_size(STACK);
        let thread = deep
            .spawn_scoped(scope, guarded)
            .map_err(|e| format!("there is no thread for a graph of {operators} operators: {e}"))?;
        thread.join().and_then(|done| done).map_err(gave_up)
    })
}

/// Silences panics of the runtime; all others go to the previous hook.
fn silence() {
    static ONCE: Once = Once::new();
    if std::thread::panicking() {
        return; // a hook cannot be set then
    }
    ONCE.call_once(|| {
        let before = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |info| {
            // operators run on the runtime's own threads
            let thread = std::thread::current();
            let own = thread.name().is_some_and(|name| name.starts_with("rten-")) && CALLS.load(Ordering::Relaxed) > 0;
            if !own && !INSIDE.get() {
                before(info);
            }
        }));
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_an_error_with_its_text() {
        let calm = call(1, || 5);
        assert_eq!(calm, Ok(5));
        for operators in [1, SHALLOW + 1] {
            let broken: Result<(), _> = call(operators, || panic!("{operators} is too much"));
            let said = format!("the runtime gave up on it: {operators} is too much");
            assert_eq!(broken, Err(said));
        }
    }
}
