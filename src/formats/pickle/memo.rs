//! The places in a pickle's memo that are recalled later.

use crate::limits::Limits;

/// The length of each opcode with its argument, if that is fixed and the opcode recalls nothing; otherwise 0.
const PLAIN: [u8; 256] = {
    let mut lengths = [1; 256];
    let others = b".hj\x8aC\x8cXB\x8d\x8e\x96c";
    let mut k = 0;
    while k < others.len() {
        lengths[others[k] as usize] = 0;
        k += 1;
    }
    let longer = b"\x80\x02K\x02q\x02M\x03J\x05r\x05\x95\x09G\x09";
    k = 0;
    while k < longer.len() {
        lengths[longer[k] as usize] = longer[k + 1];
        k += 2;
    }
    lengths
};

/// Finds the places in the memo that are recalled later. The search ends at the first fault, at which reading fails as well.
pub(super) fn recalled(bytes: &[u8], limits: &Limits) -> Vec<bool> {
    let mut recalled = Vec::new();
    let mut rest = bytes;
    while let Some((&opcode, after)) = rest.split_first() {
        // most opcodes are of these
        let plain = PLAIN[usize::from(opcode)];
        if plain > 0 {
            match rest.get(usize::from(plain)..) {
                Some(after) => rest = after,
                None => break,
            }
            continue;
        }
        let number = |n: usize| {
            after
                .get(..n)
                .map(|b| b.iter().rev().fold(0_u64, |x, &b| x << 8 | u64::from(b)))
        };
        let index = match opcode {
            b'h' => number(1),
            b'j' => number(4),
            _ => None,
        };
        if let Some(index) = index
            .and_then(|i| usize::try_from(i).ok())
            .filter(|i| *i < limits.pickle_objects)
        {
            recalled.resize(recalled.len().max(index + 1), false);
            recalled[index] = true;
        }
        let sized = |n: usize| number(n).and_then(|length| usize::try_from(length).ok()?.checked_add(n));
        let length = match opcode {
            b'.' => None,
            b'h' => Some(1),
            b'j' => Some(4),
            0x8a | 0x8c | b'C' => sized(1),
            b'X' | b'B' => sized(4),
            0x8d | 0x8e | 0x96 => sized(8),
            b'c' => {
                let mut ends = (0..after.len()).filter(|&k| after[k] == b'\n');
                ends.nth(1).map(|end| end + 1)
            }
            _ => Some(0),
        };
        match length.and_then(|n| after.get(n..)) {
            Some(after) => rest = after,
            None => break,
        }
    }
    recalled
}
