//! Flexes: deformable bodies, whose vertices are points of bodies.

use crate::math::Vec3;

/// How elements of one flex look for contacts with each other (MuJoCo's `mjtFlexSelf`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FlexSelfCollide {
    /// They do not touch.
    None,
    /// All pairs of active elements are tested.
    Narrow,
    /// A tree of boxes finds the pairs.
    Bvh,
    /// Sweep and prune finds the pairs.
    Sap,
    /// `Sap` in three dimensions, `Bvh` in fewer.
    Auto,
}

/// A deformable body of lines, triangles or tetrahedra: MuJoCo's arrays `flex_*` and `flexedge_*`. Vertices, edges and elements count from 0 in
/// each flex.
#[derive(Clone, Debug, PartialEq)]
pub struct Flex {
    /// Name; may be empty.
    pub name: String,
    /// 1 for lines, 2 for triangles, 3 for tetrahedra (`flex_dim`). Elements have one vertex more.
    pub dim: usize,
    /// Radius of the rounded elements, m (`flex_radius`).
    pub radius: f64,
    /// Whether all vertices are on one body (`flex_rigid`).
    pub rigid: bool,
    /// Whether all vertices are at the origins of their bodies (`flex_centered`).
    pub centered: bool,
    /// First vertex among those of all flexes (`flex_vertadr`).
    pub vertadr: usize,
    /// Positions of the vertices in their bodies (nvert, 3), m (`flex_vert`).
    pub vert: Vec<Vec3>,
    /// Body of each vertex (nvert), by id (`flex_vertbodyid`).
    pub vertbodyid: Vec<usize>,
    /// First edge among those of all flexes (`flex_edgeadr`).
    pub edgeadr: usize,
    /// Vertices of each edge (nedge, 2), the lower one first (`flex_edge`).
    pub edge: Vec<[usize; 2]>,
    /// Whether the ends of each edge never move relative to each other (nedge): `flexedge_rigid`.
    pub edge_rigid: Vec<bool>,
    /// Length of each edge at `qpos0` (nedge), m: `flexedge_length0`.
    pub edge_length0: Vec<f64>,
    /// Inverse weight of each edge at `qpos0` (nedge), 1/kg: `flexedge_invweight0`.
    pub edge_invweight0: Vec<f64>,
    /// Vertices of the elements (nelem * (dim + 1)), one element after another (`flex_elem`).
    pub elem: Vec<usize>,
    /// Edges of the elements (nelem times 1, 3 or 6), one element after another (`flex_elemedge`).
    pub elemedge: Vec<usize>,
    /// Layer of each element (nelem): its distance from the surface in elements; 0 in one and two dimensions (`flex_elemlayer`).
    pub elemlayer: Vec<usize>,
    /// Vertices of the fragments of the surface (nshell * dim), one fragment after another (`flex_shell`).
    pub shell: Vec<usize>,
    /// Pairs of an element and a vertex of a neighbour, which touch where the flex folds (nevpair, 2): `flex_evpair`.
    pub evpair: Vec<[usize; 2]>,
    /// Texture coordinates of the vertices, or none (`flex_texcoord`).
    pub texcoord: Vec<[f32; 2]>,
    /// Upper triangle of each element's metric of squared edge lengths (nelem, 21); empty without elasticity (`flex_stiffness`).
    pub stiffness: Vec<[f64; 21]>,
    /// Rayleigh damping of elasticity, s (`flex_damping`).
    pub damping: f64,
    /// Stiffness of the edges, N/m (`flex_edgestiffness`).
    pub edgestiffness: f64,
    /// Damping of the edges, N s/m (`flex_edgedamping`).
    pub edgedamping: f64,
    /// Whether an equality holds the lengths of the edges (`flex_edgeequality`).
    pub edgeequality: bool,
    /// Bits matched with `conaffinity` of others (`flex_contype`).
    pub contype: u32,
    /// Bits matched with `contype` of others (`flex_conaffinity`).
    pub conaffinity: u32,
    /// Dimension of contacts: 1, 3, 4 or 6 (`flex_condim`).
    pub condim: usize,
    /// Priority where contact parameters are mixed (`flex_priority`).
    pub priority: i32,
    /// Sliding, torsional and rolling friction (`flex_friction`).
    pub friction: [f64; 3],
    /// Weight where contact parameters are mixed (`flex_solmix`).
    pub solmix: f64,
    /// `solref` of contacts (`flex_solref`).
    pub solref: [f64; 2],
    /// `solimp` of contacts (`flex_solimp`).
    pub solimp: [f64; 5],
    /// Distance at which contacts are found, m (`flex_margin`).
    pub margin: f64,
    /// Part of the margin in which contacts exert no force, m (`flex_gap`).
    pub gap: f64,
    /// Whether vertices and elements that belong together may touch (`flex_internal`).
    pub internal: bool,
    /// How elements of the flex look for contacts with each other (`flex_selfcollide`).
    pub selfcollide: FlexSelfCollide,
    /// Number of layers whose elements touch in three dimensions (`flex_activelayers`).
    pub activelayers: i32,
    /// Visual group; up to 2 are drawn (`flex_group`).
    pub group: i32,
    /// Material, by id (`flex_matid`).
    pub material: Option<usize>,
    /// Red, green, blue, opacity, 0..1 (`flex_rgba`).
    pub rgba: [f64; 4],
    /// Whether the faces of the surface are shaded flat (`flex_flatskin`).
    pub flatskin: bool,
}

impl Flex {
    /// Returns the number of edges of an element.
    pub fn elem_edges(&self) -> usize {
        [1, 3, 6][self.dim.clamp(1, 3) - 1]
    }

    /// Returns the number of elements.
    pub fn nelem(&self) -> usize {
        self.elem.len() / (self.dim + 1)
    }

    /// Returns the vertices of an element.
    pub fn element(&self, e: usize) -> &[usize] {
        &self.elem[e * (self.dim + 1)..(e + 1) * (self.dim + 1)]
    }

    /// Returns whether the edges exert forces, so that the derivatives of their lengths are needed.
    pub fn edges_pull(&self) -> bool {
        !self.rigid
            && (self.edgeequality || self.edgedamping != 0.0 || self.edgestiffness != 0.0 || self.damping != 0.0)
    }
}

impl super::Arrays {
    /// Returns the number of vertices of all flexes.
    pub fn nflexvert(&self) -> usize {
        self.flexes.last().map_or(0, |flex| flex.vertadr + flex.vert.len())
    }

    /// Returns the number of edges of all flexes.
    pub fn nflexedge(&self) -> usize {
        self.flexes.last().map_or(0, |flex| flex.edgeadr + flex.edge.len())
    }
}
