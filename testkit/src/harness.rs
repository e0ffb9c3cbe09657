//! Tests that declare their needs. A test whose needs are missing is ignored with the reason, never passed.
//!
//! A test binary with `harness = false` lists its tests with [`trials!`](crate::trials) and hands them to [`run`]:
//!
//! ```
//! use testkit::harness::{Need, Trial, run_with};
//! use testkit::{show, trials};
//!
//! const NETWORK: Need = Need::new("network", None, || Err("no route to the host".to_string()));
//!
//! fn two_and_two_are_four() {
//!     show!("2 + 2 = {}", 2 + 2);
//! }
//!
//! fn the_page_loads() {
//!     unreachable!("ignored, as the need is missing");
//! }
//!
//! let all: Vec<Trial> = [trials![two_and_two_are_four], trials![needs NETWORK: the_page_loads]].concat();
//! let conclusion = run_with(["example"], all);
//! assert_eq!((conclusion.num_passed, conclusion.num_ignored), (1, 1));
//! ```
//!
//! It takes the options of `cargo test` and answers `cargo nextest` as Rust's own harness does. What a test says with
//! [`show!`](crate::show) is printed when it fails, or with `--show-output` or `--nocapture`.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::io::Write as _;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::process::ExitCode;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use libtest_mimic::{Arguments, Completion, Conclusion, Failed};

/// Something that a test needs and a machine may lack.
#[derive(Clone, Copy)]
pub struct Need {
    /// One or two words, which precede the names of the tests in lists.
    pub name: &'static str,
    /// An environment variable with which a missing need is a failure, if its value is `required`.
    pub required_by: Option<&'static str>,
    /// Finds it, setting it up if possible; otherwise returns why it is missing.
    pub check: fn() -> Result<(), String>,
}

impl Need {
    /// Describes a need.
    pub const fn new(name: &'static str, required_by: Option<&'static str>, check: fn() -> Result<(), String>) -> Self {
        Self {
            name,
            required_by,
            check,
        }
    }

    /// Returns the result of the check, which is made once per process.
    fn checked(&self) -> Result<(), String> {
        type Checked = Arc<OnceLock<Result<(), String>>>;
        static CHECKS: Mutex<BTreeMap<&'static str, Checked>> = Mutex::new(BTreeMap::new());
        let mut checks = CHECKS.lock().unwrap_or_else(PoisonError::into_inner);
        let cell = checks.entry(self.name).or_default().clone();
        drop(checks);
        cell.get_or_init(self.check).clone()
    }

    fn is_required(&self) -> bool {
        let value = self.required_by.and_then(std::env::var_os);
        value.is_some_and(|value| value == "required")
    }
}

/// Time: the test takes minutes, which `scripts/test.sh quick` (the variable `QUICK=yes`) does not spend.
pub const TIME: Need = Need::new("time", None, || match std::env::var_os("QUICK") {
    Some(value) if value == "yes" => Err("`scripts/test.sh quick` leaves out what takes minutes".to_string()),
    _ => Ok(()),
});

/// A test: its path, what it needs, and its function.
#[derive(Clone, Copy)]
pub struct Trial {
    /// The path of its function, crate included.
    pub path: &'static str,
    /// Its requirements.
    pub needs: &'static [Need],
    /// The function, which panics when the test fails.
    pub run: fn(),
}

/// Lists functions as tests: `trials![one, two]`, or `trials![needs KIT, GPU: one, two]` with their needs.
#[macro_export]
macro_rules! trials {
    (needs $($need:path),+ : $($test:ident),+ $(,)?) => {{
        const NEEDS: &[$crate::harness::Need] = &[$($need),+];
        $crate::trials![in NEEDS: $($test),+]
    }};
    (in $needs:ident: $($test:ident),+) => {
        vec![$($crate::harness::Trial {
            path: concat!(module_path!(), "::", stringify!($test)),
            needs: $needs,
            run: $test,
        }),+]
    };
    ($($test:ident),+ $(,)?) => {{
        const NEEDS: &[$crate::harness::Need] = &[];
        $crate::trials![in NEEDS: $($test),+]
    }};
}

/// Prints a line about the running test, as `println!` does under Rust's own harness.
#[macro_export]
macro_rules! show {
    ($($part:tt)*) => { $crate::harness::show(format_args!($($part)*)) };
}

thread_local! {
    /// The output of this thread's test, while it is held back.
    static SAID: RefCell<Option<String>> = const { RefCell::new(None) };
}

/// Keeps a line in case the test fails, or prints it if output is not held back.
pub fn show(line: std::fmt::Arguments) {
    let kept = SAID.with_borrow_mut(|said| {
        let text = said.as_mut()?;
        text.push_str(&line.to_string());
        text.push('\n');
        Some(())
    });
    if kept.is_none() {
        println!("{line}");
    }
}

/// Runs a test, and prints its output when it fails or when all output is to be shown.
fn run_kept(name: &str, test: fn(), arguments: &Arguments) {
    SAID.set((!arguments.nocapture).then(String::new));
    let result = catch_unwind(AssertUnwindSafe(test));
    let said = SAID.take().unwrap_or_default();
    if !said.is_empty() && (result.is_err() || arguments.show_output) {
        println!("\n---- {name} ----\n{said}");
    }
    if let Err(panic) = result {
        resume_unwind(panic);
    }
}

/// Returns why a test cannot run: the first missing need, and whether that is a failure.
fn missing(trial: &Trial) -> Option<(String, bool)> {
    trial.needs.iter().find_map(|need| {
        let reason = need.checked().err()?;
        Some((format!("needs {}: {reason}", need.name), need.is_required()))
    })
}

/// Runs the tests selected by the arguments of the process, and finally prints what was ignored and why.
pub fn run(trials: Vec<Trial>) -> ExitCode {
    let conclusion = run_with(std::env::args_os(), trials);
    end_at_once(&conclusion);
    conclusion.exit_code()
}

/// Ends the process at once with the tests' result, on Unix.
///
/// An ordinary end calls what libraries registered for it while threads of the software drivers for graphics still run, and about one
/// process in ten of a loaded machine then died of a damaged heap, after its last test had passed.
fn end_at_once(conclusion: &Conclusion) {
    let flushed = std::io::stdout().flush();
    #[cfg(unix)]
    signal_hook::low_level::exit(match flushed {
        Ok(()) if !conclusion.has_failed() => 0,
        _ => 101, // as Rust's own harness ends
    });
    #[cfg(not(unix))]
    let _ = (flushed, conclusion);
}

/// Runs the tests selected by these arguments, the first of which is the name of the program.
pub fn run_with<A: Into<OsString> + Clone>(arguments: impl IntoIterator<Item = A>, trials: Vec<Trial>) -> Conclusion {
    let arguments = Arc::new(Arguments::from_iter(arguments));
    // other programs request lists, and look for ignored tests in them
    let listed = arguments.list || arguments.ignored;
    let ignored: Arc<Mutex<BTreeMap<String, String>>> = Arc::default();
    let tests = trials.into_iter().map(|trial| {
        let name = trial
            .path
            .split_once("::")
            .map_or(trial.path, |(_, rest)| rest)
            .to_string();
        let kind = trial.needs.iter().map(|need| need.name).collect::<Vec<_>>().join(", ");
        let lacks = listed && matches!(missing(&trial), Some((_, false)));
        let (own_name, ignored, arguments) = (name.clone(), ignored.clone(), arguments.clone());
        let test = move || match missing(&trial) {
            Some((reason, true)) => Err(Failed::from(format!("required, but missing: {reason}"))),
            Some((reason, false)) => {
                let mut all = ignored.lock().unwrap_or_else(PoisonError::into_inner);
                all.insert(own_name, reason.clone());
                Ok(Completion::ignored_with(reason))
            }
            None => {
                run_kept(&own_name, trial.run, &arguments);
                Ok(Completion::Completed)
            }
        };
        let test = libtest_mimic::Trial::ignorable_test(name, test);
        test.with_kind(kind).with_ignored_flag(lacks)
    });
    let conclusion = libtest_mimic::run(&arguments, tests.collect());
    let ignored = ignored.lock().unwrap_or_else(PoisonError::into_inner);
    for (name, reason) in ignored.iter() {
        println!("ignored: {name}: {reason}");
    }
    match ignored.len() {
        0 => {}
        1 => println!("1 test ignored\n"),
        n => println!("{n} tests ignored\n"),
    }
    conclusion
}

#[cfg(test)]
mod tests {
    use super::*;

    const THERE: Need = Need::new("there", None, || Ok(()));
    const MISSING: Need = Need::new("missing", None, || Err("it is not".to_string()));

    fn passes() {
        show!("kept back");
    }

    fn fails() {
        panic!("as it should");
    }

    #[test]
    fn what_lacks_a_need_is_ignored_and_what_panics_fails() {
        let trials = [
            trials![passes, fails],
            trials![needs THERE: passes],
            trials![needs THERE, MISSING: passes],
        ];
        let all = trials.concat();
        // its lines would look like those of this run
        let log = std::env::temp_dir().join(format!("testkit_{}", std::process::id()));
        let arguments = ["test", "--logfile", &log.to_string_lossy()].map(str::to_string);
        let conclusion = run_with(arguments.clone(), all.clone());
        let counts = (conclusion.num_passed, conclusion.num_failed, conclusion.num_ignored);
        assert_eq!(counts, (2, 1, 1));
        let exact = ["--exact", "harness::tests::fails"].map(str::to_string);
        let one = run_with([&arguments[..], &exact[..]].concat(), all);
        assert_eq!((one.num_failed, one.num_filtered_out), (1, 3));
        std::fs::remove_file(&log).expect("the log was written");
    }
}
