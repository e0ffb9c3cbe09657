//! Snapshots of couplings.

use rapier3d_f64::dynamics::RigidBodyHandle;
use rapier3d_f64::geometry::ColliderHandle;
use rapier3d_f64::parry::bounding_volume::Aabb;
use rapier3d_f64::parry::math::Vector;

use mjcf_sim_model::Model;

use super::impulse::Impulse;
use super::neighbors::{Neighbor, Source, meet};
use super::{Coupling, CouplingError, WorldSets};

const MAGIC: [u8; 8] = *b"RPCOUP\r\n";

/// A neighbor in a snapshot.
#[derive(Clone, Debug, PartialEq)]
struct SavedNeighbor {
    source: Source,
    slots: Vec<u32>,
    region: Option<Aabb>,
    pending: Impulse,
}

/// The memory of a coupling between steps: its neighbors and their slots.
///
/// With the state of the model and the sets of the world, which are the program's to keep, it continues a run with the same bits.
#[derive(Clone, Debug, PartialEq)]
pub struct CouplingSnapshot {
    neighbors: Vec<SavedNeighbor>,
}

impl CouplingSnapshot {
    /// Returns the snapshot as bytes, the same on all machines.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut out = MAGIC.to_vec();
        let mut word = |v: u32| out.extend_from_slice(&v.to_le_bytes());
        word(self.neighbors.len() as u32);
        for n in &self.neighbors {
            let (kind, (index, generation)) = match n.source {
                Source::Body(handle) => (0, handle.into_raw_parts()),
                Source::Fixed(handle) => (1, handle.into_raw_parts()),
            };
            [kind, index, generation, n.slots.len() as u32]
                .into_iter()
                .for_each(&mut word);
            n.slots.iter().copied().for_each(&mut word);
            word(u32::from(n.region.is_some()));
            let corners = n
                .region
                .iter()
                .flat_map(|r| [r.mins, r.maxs])
                .flat_map(|v| v.to_array());
            for v in corners.chain(n.pending.linear).chain(n.pending.angular) {
                let bits = v.to_bits();
                [bits as u32, (bits >> 32) as u32].into_iter().for_each(&mut word);
            }
        }
        out
    }

    /// Reads what [`CouplingSnapshot::to_bytes`] wrote.
    ///
    /// # Errors
    /// [`CouplingError::NotASnapshot`]
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, CouplingError> {
        Self::read(bytes).ok_or(CouplingError::NotASnapshot)
    }

    fn read(bytes: &[u8]) -> Option<Self> {
        let (words, rest) = bytes.strip_prefix(&MAGIC)?.as_chunks::<4>();
        let mut words = words.iter().map(|word| u32::from_le_bytes(*word));
        let mut neighbors = Vec::new();
        for _ in 0..words.next()? {
            let (kind, index, generation) = (words.next()?, words.next()?, words.next()?);
            let source = match kind {
                0 => Source::Body(RigidBodyHandle::from_raw_parts(index, generation)),
                1 => Source::Fixed(ColliderHandle::from_raw_parts(index, generation)),
                _ => return None,
            };
            let mut slots = Vec::new();
            for _ in 0..words.next()? {
                slots.push(words.next()?);
            }
            let known = words.next()?;
            let mut number = || {
                Some(f64::from_bits(
                    u64::from(words.next()?) | u64::from(words.next()?) << 32,
                ))
            };
            let region = match known {
                0 => None,
                1 => {
                    let mut corner = || Some(Vector::new(number()?, number()?, number()?));
                    Some(Aabb::new(corner()?, corner()?))
                }
                _ => return None,
            };
            let mut arrow = || Some([number()?, number()?, number()?]);
            let (linear, angular) = (arrow()?, arrow()?);
            if !linear.iter().chain(&angular).all(|v| v.is_finite()) {
                return None;
            }
            let pending = Impulse { linear, angular };
            neighbors.push(SavedNeighbor {
                source,
                slots,
                region,
                pending,
            });
        }
        (words.next().is_none() && rest.is_empty()).then_some(Self { neighbors })
    }
}

impl Coupling {
    /// Returns a snapshot.
    pub fn snapshot(&self) -> CouplingSnapshot {
        let saved = |n: &Neighbor| SavedNeighbor {
            source: n.source,
            slots: n.slots.iter().map(|&slot| slot as u32).collect(),
            region: n.region,
            pending: n.pending,
        };
        CouplingSnapshot {
            neighbors: self.neighbors.all.iter().map(saved).collect(),
        }
    }

    /// Restores a snapshot, after the program has restored the world. Neighbors that no longer exist are left out. The next
    /// [`Coupling::update`] returns a model.
    ///
    /// # Errors
    /// A snapshot with other slots, shapes that the model cannot have; nothing is changed then.
    pub fn restore(
        &mut self,
        snapshot: &CouplingSnapshot,
        model: &Model,
        sets: &WorldSets<'_>,
    ) -> Result<(), CouplingError> {
        let mut restored: Vec<Neighbor> = Vec::new();
        for saved in &snapshot.neighbors {
            let exists = match saved.source {
                Source::Body(handle) => sets.bodies.contains(handle),
                Source::Fixed(handle) => sets.colliders.contains(handle),
            };
            if !exists {
                continue;
            }
            // of other shapes than meshes the region is not used
            let region = saved.region.unwrap_or(Aabb::new(Vector::ZERO, Vector::ZERO));
            let mut neighbor = meet(saved.source, sets, region, &self.options, model.opt.flags.multiccd)?;
            let free = neighbor.inertia.is_some();
            let count = if free { 1 } else { neighbor.geoms.len() };
            for &slot in &saved.slots {
                let slot = slot as usize;
                let taken = restored.iter().any(|n| n.slots.contains(&slot)) || neighbor.slots.contains(&slot);
                let fits = self.slots.all.get(slot).is_some_and(|found| {
                    found.joint.is_some() == free && (!free || found.geoms.len() >= neighbor.geoms.len())
                });
                if taken || !fits {
                    return Err(CouplingError::OtherSlots);
                }
                neighbor.slots.push(slot);
            }
            if neighbor.slots.len() != count || neighbor.region.is_some() != saved.region.is_some() {
                return Err(CouplingError::OtherSlots);
            }
            neighbor.pending = saved.pending;
            restored.push(neighbor);
        }
        self.neighbors.all = restored;
        self.written = false;
        Ok(())
    }
}
