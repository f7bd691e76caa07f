//! Numbers in buffers.

use crate::buffers::source::Buffers;
use crate::document::{Accessor, Document};
use crate::error::{GltfError, Outcome, find, malformed};

/// Elements that one asset may make of its accessors in all, each use counted. It bounds memory: an
/// accessor without a view is zeros that no byte of the file stands for, and one may be named often.
pub(crate) const MOST_ELEMENTS: u64 = 1 << 26;

/// Reads accessors, up to [`MOST_ELEMENTS`].
#[derive(Debug)]
pub(crate) struct Reader<'a> {
    pub(crate) document: &'a Document,
    pub(crate) buffers: &'a Buffers,
    pub(crate) left: u64,
}

/// Elements of an accessor or of a part of a sparse one.
struct Elements<'a> {
    bytes: &'a [u8],
    stride: usize,
    count: usize,
}

impl<'a> Reader<'a> {
    /// Elements of `N` numbers. Normalised integers become numbers in \[0, 1\] or \[-1, 1\]. Of
    /// elements with fewer numbers the rest are `pad`.
    pub(crate) fn floats<const N: usize>(
        &mut self,
        index: usize,
        kinds: &[&str],
        pad: f32,
        place: &str,
    ) -> Outcome<Vec<[f32; N]>> {
        let (accessor, place) = self.accessor(index, kinds, place)?;
        let width = components(&accessor.kind);
        let decode = decoder(accessor.component_type, accessor.normalized, &place)?;
        let size = component_size(accessor.component_type);
        let read = |element: &[u8]| {
            let mut values = [pad; N];
            for (value, bytes) in values
                .iter_mut()
                .zip(element.chunks_exact(size))
                .take(width)
            {
                *value = decode(bytes);
            }
            values
        };
        let zero = std::array::from_fn(|axis| if axis < width { 0.0 } else { pad });
        self.elements(accessor, &place, size * width, zero, read)
    }

    /// Indices of vertices.
    pub(crate) fn indices(&mut self, index: usize, place: &str) -> Outcome<Vec<u32>> {
        let (accessor, place) = self.accessor(index, &["SCALAR"], place)?;
        if ![5121, 5123, 5125].contains(&accessor.component_type) {
            let what = format!(
                "componentType {} is none of indices",
                accessor.component_type
            );
            return malformed(&place, what);
        }
        let size = component_size(accessor.component_type);
        self.elements(accessor, &place, size, 0, unsigned)
    }

    fn accessor(
        &mut self,
        index: usize,
        kinds: &[&str],
        place: &str,
    ) -> Outcome<(&'a Accessor, String)> {
        let accessor = find(&self.document.accessors, index, "accessors", place)?;
        let place = format!("accessors[{index}]");
        if !kinds.contains(&accessor.kind.as_str()) {
            let what = format!(
                "type {} where {} is needed",
                accessor.kind,
                kinds.join(" or ")
            );
            return malformed(&place, what);
        }
        if component_size(accessor.component_type) == 0 {
            let what = format!("componentType {} is not one", accessor.component_type);
            return malformed(&place, what);
        }
        match self.left.checked_sub(accessor.count) {
            Some(left) => self.left = left,
            None => {
                return Err(GltfError::Limit(format!(
                    "{place}: {} elements; an asset may have {MOST_ELEMENTS} in all",
                    accessor.count
                )));
            }
        }
        Ok((accessor, place))
    }

    fn elements<T: Clone>(
        &self,
        accessor: &Accessor,
        place: &str,
        size: usize,
        zero: T,
        read: impl Fn(&[u8]) -> T,
    ) -> Outcome<Vec<T>> {
        // Fits: the count was taken from what is left.
        let count = usize::try_from(accessor.count).unwrap_or(usize::MAX);
        let mut values: Vec<T> = match accessor.buffer_view {
            Some(view) => {
                let elements =
                    self.part(view, accessor.byte_offset, size, accessor.count, place)?;
                (0..elements.count)
                    .map(|i| read(elements.get(i, size)))
                    .collect()
            }
            None => vec![zero; count],
        };
        let Some(sparse) = &accessor.sparse else {
            return Ok(values);
        };
        let place = format!("{place}.sparse");
        if sparse.count > accessor.count {
            return malformed(&place, "it replaces more elements than there are");
        }
        let kind = sparse.indices.component_type.unwrap_or(0);
        let index_size = component_size(kind);
        if ![5121, 5123, 5125].contains(&kind) {
            return malformed(&place, format!("componentType {kind} is none of indices"));
        }
        let indices = &sparse.indices;
        let places = self.part(
            indices.buffer_view,
            indices.byte_offset,
            index_size,
            sparse.count,
            &place,
        )?;
        let new = &sparse.values;
        let new = self.part(new.buffer_view, new.byte_offset, size, sparse.count, &place)?;
        for i in 0..places.count {
            let at = unsigned(places.get(i, index_size));
            match values.get_mut(at as usize) {
                Some(value) => *value = read(new.get(i, size)),
                None => return malformed(&place, format!("index {at} of {count} elements")),
            }
        }
        Ok(values)
    }

    fn part(
        &self,
        view: usize,
        offset: u64,
        size: usize,
        count: u64,
        place: &str,
    ) -> Outcome<Elements<'_>> {
        let bytes = self.buffers.view(self.document, view, place)?;
        let stride = self.document.buffer_views[view]
            .byte_stride
            .unwrap_or(size as u64);
        if stride < size as u64 {
            return malformed(place, format!("elements of {size} bytes every {stride}"));
        }
        let last = count.saturating_sub(1).checked_mul(stride);
        let end = last
            .and_then(|last| last.checked_add(offset))
            .and_then(|last| last.checked_add(if count == 0 { 0 } else { size as u64 }));
        let fits = end.is_some_and(|end| end <= bytes.len() as u64);
        let start = usize::try_from(offset)
            .ok()
            .and_then(|offset| bytes.get(offset..));
        let sizes = usize::try_from(stride)
            .ok()
            .zip(usize::try_from(count).ok());
        match (fits, start, sizes) {
            (true, Some(bytes), Some((stride, count))) => Ok(Elements {
                bytes,
                stride,
                count,
            }),
            _ => malformed(
                place,
                format!(
                    "{count} elements of {size} bytes, one every {stride} from {offset}, lie past \
                     the end of bufferViews[{view}], which has {} bytes",
                    bytes.len()
                ),
            ),
        }
    }
}

impl Elements<'_> {
    fn get(&self, index: usize, size: usize) -> &[u8] {
        let from = index * self.stride;
        self.bytes.get(from..from + size).unwrap_or_default()
    }
}

fn components(kind: &str) -> usize {
    match kind {
        "VEC2" => 2,
        "VEC3" => 3,
        "VEC4" => 4,
        _ => 1,
    }
}

fn component_size(component: u32) -> usize {
    match component {
        5120 | 5121 => 1,
        5122 | 5123 => 2,
        5125 | 5126 => 4,
        _ => 0,
    }
}

fn unsigned(bytes: &[u8]) -> u32 {
    let mut word = [0; 4];
    for (to, from) in word.iter_mut().zip(bytes) {
        *to = *from;
    }
    u32::from_le_bytes(word)
}

fn signed(bytes: &[u8]) -> f32 {
    match *bytes {
        [a] => f32::from(a.cast_signed()),
        [a, b] => f32::from(i16::from_le_bytes([a, b])),
        _ => 0.0,
    }
}

/// How the bytes of a component become a number.
fn decoder(component: u32, normalized: bool, place: &str) -> Outcome<fn(&[u8]) -> f32> {
    Ok(match (component, normalized) {
        (5126, _) => |bytes| f32::from_bits(unsigned(bytes)),
        (5120, false) | (5122, false) => signed,
        (5120, true) => |bytes| (signed(bytes) / 127.0).max(-1.0),
        (5122, true) => |bytes| (signed(bytes) / 32_767.0).max(-1.0),
        (5121, false) | (5123, false) => |bytes| unsigned(bytes) as f32,
        (5121, true) => |bytes| unsigned(bytes) as f32 / 255.0,
        (5123, true) => |bytes| unsigned(bytes) as f32 / 65_535.0,
        _ => {
            return malformed(
                place,
                format!("componentType {component} is none of numbers"),
            );
        }
    })
}
