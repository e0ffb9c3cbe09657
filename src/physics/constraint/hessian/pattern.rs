//! The nonzero tiles of an island's Hessian, and the order in which rows are eliminated.

use super::{Hessian, NONE};
use crate::constraint::island::Island;
use crate::tiles::ZERO;

impl Hessian {
    /// Finds the pattern for an island.
    #[inline(always)]
    pub(crate) fn analyse(&mut self, island: &Island) {
        let n = island.tiles();
        self.words = n.div_ceil(64);
        let words = self.words;
        self.bits.clear();
        self.bits.resize(n * words, 0);
        for i in 0..n {
            for &j in island.m_pattern.cols(i) {
                set(&mut self.bits[i * words..], j);
            }
        }
        let several = island.several.iter().map(|s| &s.1);
        for j in several.chain(island.cones.iter().map(|c| &c.1)) {
            // all columns of a constraint couple to each other; elimination hands the coupling down from the last one
            // to the lower rows, so that it need not be entered there
            if let [cols @ .., last] = island.cols(j) {
                let row = *last as usize * words;
                cols.iter().for_each(|&c| set(&mut self.bits[row..], c));
            }
        }
        // while contacts stay between the same parts, so does the pattern
        if self.inv.len() != n || self.bits != self.analysed {
            self.analysed.clone_from(&self.bits);
            self.eliminate(n);
            let tiles = self.pattern.tiles();
            self.h.resize(tiles, ZERO);
            self.factor.resize(tiles, ZERO);
            self.inv.resize(n, [0.0; 4]);
        }
        self.changed.clear();
        // a factor of another island, or of other contacts, is no use
        self.changed.resize(n, true);
        self.weight.clear();
        self.zone.clear();
    }

    /// Eliminates symbolically, then collects the columns of each row.
    #[inline(always)]
    fn eliminate(&mut self, n: usize) {
        let words = self.words;
        self.child.clear();
        self.child.resize(n, NONE);
        self.sibling.clear();
        self.sibling.resize(n, NONE);
        for i in (0..n).rev() {
            let (head, row) = self.bits.split_at_mut(i * words);
            // the diagonal is always there, and would be found as the last column
            row[i / 64] &= !(1 << (i % 64));
            // a row hands its pattern to its last nonzero column, its parent in the elimination tree (Liu, "The role of
            // elimination trees in sparse factorization", SIAM Journal on Matrix Analysis and Applications 11, 1990):
            // the parent couples the columns in the same way, so handing it to them as well would add nothing
            if let Some(w) = (0..words).rev().find(|&w| row[w] != 0) {
                let j = w * 64 + 63 - row[w].leading_zeros() as usize;
                let target = &mut head[j * words..(j + 1) * words];
                for (t, r) in target.iter_mut().zip(&row[..words]) {
                    *t |= r;
                }
                self.sibling[i] = self.child[j];
                self.child[j] = i as u32;
            }
        }
        self.pattern.clear();
        // never smaller: places outside the pattern may be stale, as no one asks for them
        self.place.resize((n * n).max(self.place.len()), 0);
        self.update_adr.clear();
        let mut updates = 0;
        for i in 0..n {
            let start = self.pattern.tiles();
            let mut push = |col: usize| {
                self.place[i * n + col] = self.pattern.tiles() as u32;
                self.pattern.push_col(col as u32);
            };
            for w in 0..words {
                let mut bits = self.bits[i * words + w];
                while bits != 0 {
                    push(w * 64 + bits.trailing_zeros() as usize);
                    // clears the lowest bit
                    bits &= bits - 1;
                }
            }
            push(i);
            self.pattern.end_row();
            let cols = self.pattern.tiles() - start - 1;
            self.update_adr.push(updates);
            updates += cols * (cols + 1) / 2;
        }
        self.update.resize(updates, ZERO);
    }
}

#[inline(always)]
fn set(bits: &mut [u64], i: u32) {
    bits[i as usize / 64] |= 1 << (i % 64);
}
