//! The structure of a model's tree, derived once for the dynamics: ancestor chains, trees, the layout of the inertia.

use crate::body_simple::alone;
use crate::model::Arrays;
use crate::tiles::{Lanes, Pattern, Tile, ZERO};

mod dof_rows;
pub(crate) mod tendon_paths;

use dof_rows::DofRows;
use tendon_paths::TendonPaths;

/// The structure of the tree of a [`mjcf_sim_model::Model`], derived for the dynamics: ancestor chains, trees, the layout of matrices.
///
/// A *tree* is a set of degrees of freedom that depend on each other, a consecutive range. Row `i` of the joint-space
/// inertia is nonzero for `i` and its ancestors only; the chain of an ancestor is a prefix of the chain of its
/// descendant. Matrices are stored in tiles of four by four.
#[derive(Clone, Debug)]
pub struct Topology {
    /// First degree of freedom of each tree, and one past the last: `ntree + 1` values.
    pub tree_adr: Vec<usize>,
    /// Tree of each degree of freedom.
    pub dof_tree: Vec<usize>,
    /// Start of each degree of freedom in `chain`; `nv + 1` values.
    row_adr: Vec<usize>,
    /// Ancestors of each degree of freedom, ascending, followed by itself.
    chain: Vec<u32>,
    /// The last degree of freedom that moves a body, if any does.
    pub body_last_dof: Vec<Option<usize>>,
    /// Lane of each degree of freedom: four times its tile, plus its place in the tile. The lanes of a tile are consecutive.
    pub slot: Vec<u32>,
    /// First degree of freedom of each tile, and one past the last.
    pub tile_dof: Vec<usize>,
    /// First tile of each tree, and one past the last: `ntree + 1` values.
    pub tile_adr: Vec<usize>,
    /// Tiles of the inertia: each row of tiles has the tiles of its ancestors, which are a prefix of its descendants'.
    pub tiles: Pattern,
    /// Tiles that move each body, with the number of their lanes that do.
    body_tiles: Vec<(u32, u32)>,
    body_tile_adr: Vec<usize>,
    /// Degrees of freedom that can change the length of each tendon.
    pub tendons: DofRows,
    /// Degrees of freedom that can change the length of each edge, in flexes whose edges pull.
    pub flexedges: DofRows,
    /// Whether each body is simple with slide joints only; empty without flexes.
    pub slides_alone: Vec<bool>,
    /// The paths of spatial tendons.
    pub tendon_paths: TendonPaths,
    /// Degrees of freedom on which actuators with their own moment act; actuators on joints and tendons have none.
    pub actuators: DofRows,
    /// Those actuators, by id.
    pub own_moments: Vec<usize>,
    /// Coordinate and degree of freedom of the hinge or slide that each actuator acts on, if it acts on one.
    pub actuator_scalar: Vec<Option<[u32; 2]>>,
}

impl Topology {
    /// Derives the structure of `model`.
    pub fn new(model: &Arrays) -> Self {
        let nv = model.nv;
        let mut tree_adr = Vec::new();
        let mut dof_tree = vec![0; nv];
        let mut row_adr = vec![0; nv + 1];
        let mut chain: Vec<u32> = Vec::new();
        for d in 0..nv {
            match model.dof_parentid[d] {
                None => tree_adr.push(d),
                Some(p) => chain.extend_from_within(row_adr[p]..row_adr[p + 1]),
            }
            chain.push(d as u32);
            row_adr[d + 1] = chain.len();
            dof_tree[d] = tree_adr.len() - 1;
        }
        tree_adr.push(nv);
        let mut body_last_dof = vec![None; model.nbody()];
        for b in 1..model.nbody() {
            body_last_dof[b] = match model.body_dofnum[b] {
                0 => body_last_dof[model.body_parentid[b]],
                n => Some(model.body_dofadr[b] + n - 1),
            };
        }
        let mut topology = Self {
            tree_adr,
            dof_tree,
            row_adr,
            chain,
            body_last_dof,
            slot: Vec::with_capacity(nv),
            tile_adr: Vec::new(),
            tile_dof: Vec::new(),
            tiles: Pattern::with_capacity(nv, nv),
            body_tiles: Vec::new(),
            body_tile_adr: Vec::new(),
            tendons: DofRows::default(),
            flexedges: DofRows::default(),
            slides_alone: alone(model),
            tendon_paths: TendonPaths::default(),
            actuators: DofRows::default(),
            own_moments: dof_rows::own_moments(model),
            actuator_scalar: dof_rows::actuator_scalar(model),
        };
        topology.deal_tiles(model);
        topology.tendons = dof_rows::tendons(model, &topology);
        topology.flexedges = dof_rows::flexedges(model, &topology);
        topology.tendon_paths = TendonPaths::new(model, &topology, &topology.tendons);
        topology.actuators = dof_rows::actuators(model, &topology);
        topology
    }

    /// Assigns degrees of freedom to tiles, four per tile, as long as each is the child of the previous one.
    fn deal_tiles(&mut self, model: &Arrays) {
        for d in 0..model.nv {
            let slot = match model.dof_parentid[d] {
                Some(p) if p + 1 == d && self.slot[p] % 4 < 3 => self.slot[p] + 1,
                parent => {
                    let tile = self.tile_dof.len();
                    if parent.is_none() {
                        self.tile_adr.push(tile);
                    }
                    self.tile_dof.push(d);
                    4 * tile as u32
                }
            };
            self.slot.push(slot);
        }
        self.tile_adr.push(self.tile_dof.len());
        self.tile_dof.push(model.nv);
        let lanes_of = |chain: &[u32], slot: &[u32]| {
            let mut tiles: Vec<(u32, u32)> = Vec::new();
            for &d in chain {
                match (tiles.last_mut(), slot[d as usize] / 4) {
                    (Some(last), tile) if last.0 == tile => last.1 += 1,
                    (_, tile) => tiles.push((tile, 1)),
                }
            }
            tiles
        };
        let mut tiles = Pattern::with_capacity(model.nv, model.nv);
        for last in &self.tile_dof[1..] {
            for (tile, _) in lanes_of(self.dof_chain(last - 1), &self.slot) {
                tiles.push_col(tile);
            }
            tiles.end_row();
        }
        self.tiles = tiles;
        for b in 0..model.nbody() {
            self.body_tile_adr.push(self.body_tiles.len());
            let tiles = lanes_of(self.body_chain(b), &self.slot);
            self.body_tiles.extend(tiles);
        }
        self.body_tile_adr.push(self.body_tiles.len());
    }

    /// Returns the tiles that move `body`, ascending, with the number of their lanes that do, which come first.
    #[inline]
    pub fn body_tiles(&self, body: usize) -> &[(u32, u32)] {
        &self.body_tiles[self.body_tile_adr[body]..self.body_tile_adr[body + 1]]
    }

    /// Returns the sum of `dof_invweight0` (nv) over a tree: the trace of its inverse inertia at `qpos0`, a bound on its acceleration under unit
    /// forces.
    #[inline]
    pub fn mobility(&self, dof_invweight0: &[f64], tree: usize) -> f64 {
        dof_invweight0[self.tree_adr[tree]..self.tree_adr[tree + 1]]
            .iter()
            .sum()
    }

    /// Returns the number of lanes of a tile that have a degree of freedom.
    #[inline]
    pub fn lanes(&self, tile: usize) -> usize {
        self.tile_dof[tile + 1] - self.tile_dof[tile]
    }

    /// Returns the tree of a tile.
    #[inline]
    pub fn tile_tree(&self, tile: usize) -> usize {
        self.dof_tree[self.tile_dof[tile]]
    }

    /// Returns the tiles of a matrix without entries: ones on the diagonal of the lanes that have no degree of freedom.
    pub fn new_tiles(&self) -> Vec<Tile> {
        let mut tiles = vec![ZERO; self.tiles.tiles()];
        for row in 0..self.tiles.rows() {
            let diagonal = &mut tiles[self.tiles.start(row + 1) - 1];
            for k in self.lanes(row)..4 {
                diagonal[k][k] = 1.0;
            }
        }
        tiles
    }

    /// Iterates over row `dof` of a matrix in tiles, over the ancestors of `dof` and itself, ascending.
    pub fn row<'a>(&'a self, tiles: &'a [Tile], dof: usize) -> impl Iterator<Item = (usize, f64)> + 'a {
        let (row, r) = (self.slot[dof] as usize / 4, self.slot[dof] as usize % 4);
        let cols = self.tiles.cols(row);
        self.dof_chain(dof).iter().map(move |&a| {
            let slot = self.slot[a as usize];
            let place = cols.partition_point(|&c| c < slot / 4);
            (a as usize, tiles[self.tiles.start(row) + place][r][slot as usize % 4])
        })
    }

    /// Expands the symmetric matrix in `tiles` to the full matrix (nv, nv), row by row.
    pub fn full(&self, tiles: &[Tile]) -> Vec<f64> {
        let nv = self.dof_tree.len();
        let mut matrix = vec![0.0; nv * nv];
        for i in 0..nv {
            for (j, value) in self.row(tiles, i) {
                matrix[i * nv + j] = value;
                matrix[j * nv + i] = value;
            }
        }
        matrix
    }

    /// Copies a vector over the degrees of freedom to `lanes`; lanes without a degree of freedom keep their values.
    #[inline]
    pub fn to_lanes(&self, x: &[f64], lanes: &mut [Lanes]) {
        for (&slot, &v) in self.slot.iter().zip(x) {
            lanes[slot as usize / 4][slot as usize % 4] = v;
        }
    }

    /// Copies the values of the degrees of freedom from `lanes` to the vector `x`.
    #[inline]
    pub fn read_lanes(&self, lanes: &[Lanes], x: &mut [f64]) {
        for (&slot, v) in self.slot.iter().zip(x) {
            *v = lanes[slot as usize / 4][slot as usize % 4];
        }
    }

    /// Returns the number of trees.
    pub fn ntree(&self) -> usize {
        self.tree_adr.len() - 1
    }

    /// Returns the ancestors of `dof`, ascending, followed by itself.
    #[inline]
    pub fn dof_chain(&self, dof: usize) -> &[u32] {
        &self.chain[self.row_adr[dof]..self.row_adr[dof + 1]]
    }

    /// Returns where the chain of `dof` begins among the entries of all chains; for `dof = nv`, their number.
    #[inline]
    pub fn chain_start(&self, dof: usize) -> usize {
        self.row_adr[dof]
    }

    /// Returns the index of `ancestor` in the chain of `dof`, among the entries of all chains, if it is there.
    #[inline]
    pub fn chain_place(&self, ancestor: usize, dof: usize) -> Option<usize> {
        // the chain of an ancestor is a prefix, so its length tells the place
        let place = self.row_adr[ancestor + 1] - self.row_adr[ancestor] - 1;
        let there = self.dof_chain(dof).get(place).is_some_and(|&d| d as usize == ancestor);
        there.then_some(self.row_adr[dof] + place)
    }

    /// Returns the degrees of freedom that move `body`, ascending.
    #[inline]
    pub fn body_chain(&self, body: usize) -> &[u32] {
        match self.body_last_dof[body] {
            Some(d) => self.dof_chain(d),
            None => &[],
        }
    }

    /// Returns the degrees of freedom that move only one of two bodies, for each of them, ascending.
    pub fn apart(&self, a: usize, b: usize) -> (&[u32], &[u32]) {
        let (chain_a, chain_b) = (self.body_chain(a), self.body_chain(b));
        let shared = chain_a.iter().zip(chain_b).take_while(|(a, b)| a == b).count();
        (&chain_a[shared..], &chain_b[shared..])
    }
}
