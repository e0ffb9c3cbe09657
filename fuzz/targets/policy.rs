//! Answers of programs that are policies, as they come through the pipe.
#![no_main]

use babybench::policy::answers;
use libfuzzer_sys::fuzz_target;

const NUMBERS: usize = 3;

fuzz_target!(|data: &[u8]| {
    for answer in answers(data, NUMBERS, 64) {
        match answer {
            Ok(action) => {
                assert_eq!(action.len(), NUMBERS);
                assert!(action.iter().all(|v| v.is_finite()), "{action:?}");
            }
            Err(said) => assert!(said.len() < 2000 && !said.chars().any(char::is_control), "{said:?}"),
        }
    }
});
