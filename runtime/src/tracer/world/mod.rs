//! A scene's triangles in the order of two levels of hierarchies.
//!
//! The first level is in world space. Its leaves hold triangles, and instances of meshes that are
//! placed several times: such a mesh has a hierarchy of its own, stored once. Meshes that are placed
//! once, and small ones, are placed here, so that a scene without repetition has one level.

mod cutout;
mod instance;
mod mesh;
#[cfg(test)]
#[cfg(feature = "blocking")]
mod tests;

use glam::{Vec3, Vec3A};
use obvhs::aabb::Aabb;
use obvhs::cwbvh::CwBvh;
use obvhs::triangle::Triangle;
use vtex_shaders::LinkContext;

use super::bvh;
use super::records::{AttributeRecord, NONE, TriangleRecord};
use crate::RuntimeError;
use crate::scene::{Instance, MAX_TRIANGLES, RectLight, Scene};
pub(super) use cutout::Cutout;
use instance::{Placement, RECORD_GROUPS, record};
use mesh::{MeshTree, Placed, WHITE, triangle_record};

/// Deepest path through both levels that the shader's stack holds; see `STACK_SIZE` there.
const MAX_DEPTH: usize = 32;
/// What an instance may leave on the stack besides: nodes and triangles beside it.
const INSTANCE_STACK: usize = 2;
/// Most triangles that the copies of a mesh may come to for it to be placed rather than instanced:
/// two megabytes, for rays that need not change spaces.
const MOST_PLACED: usize = 16_384;
/// A node is this many groups of four words.
const NODE_GROUPS: usize = 5;

/// Both levels as the shader reads them.
#[derive(Debug, Default)]
pub(super) struct World {
    /// Nodes of all hierarchies, the first level's first, then the records of instances; groups of
    /// four words.
    pub(super) nodes: Vec<[u32; 4]>,
    pub(super) triangles: Vec<TriangleRecord>,
    pub(super) attributes: Vec<AttributeRecord>,
    /// Of each triangle the colours of its vertices; empty where all are white.
    pub(super) colors: Vec<[u32; 4]>,
    /// Of the scene, lights included and each instance counted in full.
    pub(super) triangle_count: u32,
    /// Those among them that no ray can meet and that are left out.
    pub(super) dropped: u32,
    /// Entries of the first level.
    pub(super) first_level: u32,
    /// A distance at which a ray that starts in the scene has left it.
    pub(super) reach: f32,
    /// Number in its mesh of each stored triangle; of one that is placed, number in the scene.
    sources: Vec<u32>,
    /// Number in the scene of the first triangle of each instance that has a record.
    instance_sources: Vec<u32>,
    /// Group of the first record of an instance.
    first_record: u32,
}

impl World {
    pub(super) fn new(scene: &Scene) -> Result<Self, RuntimeError> {
        Self::with_most_placed(scene, MOST_PLACED)
    }

    /// The same with another limit than [`MOST_PLACED`].
    fn with_most_placed(scene: &Scene, most_placed: usize) -> Result<Self, RuntimeError> {
        let placements = instance::placements(scene, most_placed);
        check_counts(scene, &placements)?;
        let mut is_instanced = vec![false; scene.meshes.len()];
        for (instance, placement) in scene.instances.iter().zip(&placements) {
            is_instanced[instance.mesh] |= placement.is_instanced();
        }
        let trees: Vec<Option<MeshTree>> = (scene.meshes.iter().zip(is_instanced))
            .map(|(mesh, is_instanced)| is_instanced.then(|| MeshTree::new(mesh)))
            .collect();
        let mut world = Self::default();
        let first_level = FirstLevel::new(scene, &placements, &trees);
        world.triangle_count = first_level.triangle_count;
        world.dropped = first_level.dropped;
        world.add_levels(first_level, trees, scene)?;
        Ok(world)
    }

    /// Lays out the hierarchies one behind the other, then the records.
    fn add_levels(
        &mut self,
        first: FirstLevel,
        trees: Vec<Option<MeshTree>>,
        scene: &Scene,
    ) -> Result<(), RuntimeError> {
        let tree = bvh::build(&first.boxes);
        let depth = bvh::depth(&tree);
        self.first_level = index_u32(first.boxes.len());
        if self.first_level > 0 {
            let Aabb { min, max } = tree.total_aabb;
            self.reach = 1.01 * (max - min).length();
        }
        self.push_nodes(&tree);
        let mut entries: Vec<Entry> = Vec::with_capacity(first.boxes.len());
        for &index in &tree.primitive_indices {
            entries.push(first.entries[index as usize]);
        }
        for entry in &entries {
            self.push_triangle(match entry {
                Entry::Placed(placed) => *placed,
                // Its link is written when it is known where records lie.
                Entry::Instance { .. } => Placed::default(),
            });
        }
        let mut deepest = 0;
        let mut roots = Vec::with_capacity(trees.len());
        for tree in trees {
            roots.push(index_u32(self.nodes.len() / NODE_GROUPS));
            if let Some(tree) = tree {
                deepest = deepest.max(INSTANCE_STACK + tree.depth());
                self.push_nodes(&tree.bvh);
                tree.placed_in_order()
                    .for_each(|placed| self.push_triangle(placed));
            }
        }
        if depth + deepest > MAX_DEPTH {
            return Err(RuntimeError::Limit(format!(
                "BVH of {} levels: is the mesh degenerate?",
                depth + deepest
            )));
        }
        if scene.meshes.iter().all(|mesh| mesh.colors.is_empty()) {
            self.colors = Vec::new();
        }
        self.first_record = index_u32(self.nodes.len());
        for (at, entry) in entries.iter().enumerate() {
            let Entry::Instance {
                index,
                first_source,
            } = *entry
            else {
                continue;
            };
            let link = index_u32(self.nodes.len());
            self.triangles[at].v0[3] = f32::from_bits(link);
            let instance = &scene.instances[index];
            let is_veil = scene.materials[instance.material].is_veil();
            self.nodes
                .extend(record(instance, roots[instance.mesh], is_veil));
            self.instance_sources.push(first_source);
        }
        Ok(())
    }

    /// Appends a hierarchy whose triangles come next.
    fn push_nodes(&mut self, tree: &CwBvh) {
        let first_node = index_u32(self.nodes.len() / NODE_GROUPS);
        let first_triangle = index_u32(self.triangles.len());
        for node in &tree.nodes {
            let mut node = *node;
            node.child_base_idx += first_node;
            node.primitive_base_idx += first_triangle;
            let words: [[u32; 4]; NODE_GROUPS] = bytemuck::cast(node);
            self.nodes.extend(words);
        }
    }

    fn push_triangle(&mut self, placed: Placed) {
        self.triangles.push(placed.triangle);
        self.attributes.push(placed.attributes);
        self.colors.push(placed.colors);
        self.sources.push(placed.source);
    }

    /// `context` with the traversal that this scene needs: any text that imports `trace/bvh` is to be
    /// linked with it.
    pub(super) fn levels(&self, context: LinkContext) -> LinkContext {
        match self.instance_sources.is_empty() {
            true => vtex_shaders::without_instances(context),
            false => context,
        }
    }

    /// Drops what only the device reads.
    pub(super) fn free_uploaded(&mut self) {
        self.nodes = Vec::new();
        self.triangles = Vec::new();
        self.attributes = Vec::new();
    }

    /// Number in the scene of a triangle that a ray met, by its index here and the group of its
    /// instance's record, 0 for none.
    pub(super) fn source_triangle(&self, triangle: u32, instance: u32) -> u32 {
        let own = self.sources.get(triangle as usize).copied().unwrap_or(NONE);
        let record = instance.wrapping_sub(self.first_record) as usize / RECORD_GROUPS;
        match self.instance_sources.get(record) {
            Some(first) if instance != 0 => first.saturating_add(own),
            _ => own,
        }
    }
}

/// What a leaf of the first level holds.
#[derive(Clone, Copy, Debug)]
enum Entry {
    Placed(Placed),
    Instance { index: usize, first_source: u32 },
}

/// The first level before its hierarchy is built.
#[derive(Debug, Default)]
struct FirstLevel {
    boxes: Vec<Aabb>,
    entries: Vec<Entry>,
    triangle_count: u32,
    dropped: u32,
}

impl FirstLevel {
    fn new(scene: &Scene, placements: &[Placement], trees: &[Option<MeshTree>]) -> Self {
        let mut level = Self::default();
        for (index, (instance, placement)) in scene.instances.iter().zip(placements).enumerate() {
            match (&trees[instance.mesh], placement) {
                (Some(tree), Placement::Instanced(to_world)) => {
                    let count = index_u32(scene.meshes[instance.mesh].triangles.len());
                    let first_source = level.triangle_count;
                    level.triangle_count += count;
                    level.dropped += match tree.bounds_in(to_world) {
                        Some(bounds) => {
                            level.boxes.push(bounds);
                            level.entries.push(Entry::Instance {
                                index,
                                first_source,
                            });
                            tree.dropped()
                        }
                        None => count,
                    };
                }
                _ => level.place(scene, instance),
            }
        }
        // Each light has a material of its own behind the scene's, see `material_records`.
        for (light, material) in scene.lights.iter().zip(scene.materials.len()..) {
            level.place_light(light, index_u32(material));
        }
        level
    }

    fn place(&mut self, scene: &Scene, instance: &Instance) {
        let mesh = &scene.meshes[instance.mesh];
        let is_veil = scene.materials[instance.material].is_veil();
        let material = index_u32(instance.material);
        let placed = mesh::placed(mesh, &instance.world_from_object, material);
        for (triangle, attributes, colors) in placed {
            self.push(&triangle, is_veil, attributes, colors);
        }
    }

    /// Lights are met by chance too, so they are geometry: two triangles, counter-clockwise seen
    /// from where they shine.
    fn place_light(&mut self, light: &RectLight, material: u32) {
        let [corner, edge_u, edge_v] = [light.corner, light.edge_u, light.edge_v].map(Vec3::from);
        let normal = edge_u.cross(edge_v).normalize_or_zero();
        let at = |u: f32, v: f32| Vec3A::from(corner + edge_u * u + edge_v * v);
        for corners in [
            [at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0)],
            [at(0.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)],
        ] {
            let attributes = mesh::attribute_record([normal.extend(0.0); 3], [0.0; 3], material);
            self.push(&bvh::triangle(corners), false, attributes, WHITE);
        }
    }

    fn push(
        &mut self,
        triangle: &Triangle,
        is_veil: bool,
        attributes: AttributeRecord,
        colors: [u32; 4],
    ) {
        let source = self.triangle_count;
        self.triangle_count += 1;
        if !bvh::is_traceable(triangle) {
            self.dropped += 1;
            return;
        }
        self.boxes.push(triangle.aabb());
        self.entries.push(Entry::Placed(Placed {
            triangle: triangle_record(triangle, is_veil),
            attributes,
            colors,
            source,
        }));
    }
}

/// Counted before anything is placed: a small mesh with many instances must not fill memory.
fn check_counts(scene: &Scene, placements: &[Placement]) -> Result<(), RuntimeError> {
    let mut stored = 2 * scene.lights.len();
    let mut shown = 2 * scene.lights.len();
    let mut counted = vec![false; scene.meshes.len()];
    for (instance, placement) in scene.instances.iter().zip(placements) {
        let count = scene.meshes[instance.mesh].triangles.len();
        shown = shown.saturating_add(count);
        let is_new = !std::mem::replace(&mut counted[instance.mesh], true);
        stored = stored.saturating_add(match placement.is_instanced() {
            // The mesh and an entry for each of its instances.
            true => 1 + if is_new { count } else { 0 },
            false => count,
        });
    }
    if stored > MAX_TRIANGLES {
        return Err(RuntimeError::Limit(format!(
            "{stored} triangles and instances to store; a scene holds at most {MAX_TRIANGLES}"
        )));
    }
    // Hits are numbered by 32 bits, of which one value says that there is none.
    if u32::try_from(shown).is_ok_and(|shown| shown < NONE) {
        Ok(())
    } else {
        Err(RuntimeError::Limit(format!(
            "{shown} triangles, all instances counted; rays can tell {} apart",
            NONE - 1
        )))
    }
}

/// Counts here are bounded by [`check_counts`] and by memory.
pub(super) fn index_u32(index: usize) -> u32 {
    u32::try_from(index).unwrap_or(NONE)
}
