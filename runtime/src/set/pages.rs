//! Where the texels of a pool's textures lie on its pages.

use guillotiere::{AllocId, AtlasAllocator, size2};
use vtex_shaders::{MAX_PAGE_SIDE, Place};

/// The word of a level's place has 6 bits for the page.
const MAX_PAGES: u32 = 64;

/// What bounds pages.
#[derive(Clone, Copy, Debug)]
pub(super) struct PageLimits {
    /// Sides up to which a page grows before there is a second.
    pub(super) side: u32,
    /// Sides of the device's largest texture.
    pub(super) device_side: u32,
    /// Layers of the device's largest texture.
    pub(super) device_layers: u32,
}

impl PageLimits {
    fn most_side(&self) -> u32 {
        power_of_two_within(self.device_side.min(MAX_PAGE_SIDE))
    }

    fn most_pages(&self) -> u32 {
        self.device_layers.min(MAX_PAGES)
    }
}

/// Rooms of textures on pages of one size, whose sides are powers of two: then a place divided by the
/// page's size is exact, and a texture looks the same, bit for bit, when the pages grow.
#[derive(Clone, Default)]
pub(super) struct Pages {
    size: [u32; 2],
    pages: Vec<AtlasAllocator>,
    /// How many pages there are on the device: some have no rooms yet.
    held: u32,
    texels: u64,
}

/// A rectangle of texels that a texture has.
#[derive(Clone, Copy, Debug)]
pub(super) struct Room {
    pub(super) place: Place,
    size: [u32; 2],
    id: AllocId,
}

// The allocator prints its whole tree.
impl std::fmt::Debug for Pages {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Pages")
            .field("size", &self.size)
            .field("pages", &self.pages.len())
            .field("texels", &self.texels)
            .finish()
    }
}

impl Pages {
    /// Texels along a page, along x and y; zeros where there is none.
    pub(super) fn size(&self) -> [u32; 2] {
        self.size
    }

    fn count(&self) -> u32 {
        u32::try_from(self.pages.len()).unwrap_or(u32::MAX)
    }

    /// How many pages there are on the device.
    pub(super) fn held(&self) -> u32 {
        self.held
    }

    /// In rooms.
    pub(super) fn texels(&self) -> u64 {
        self.texels
    }

    /// Where there are no pages, makes them as large as rooms of these sizes ask for.
    pub(super) fn begin(&mut self, sizes: impl Iterator<Item = [u32; 2]>, limits: &PageLimits) {
        if self.pages.is_empty() {
            let most = power_of_two_within(limits.side.min(limits.device_side));
            let sizes: Vec<[u32; 2]> = sizes.collect();
            self.size = first_size(&sizes, most).map(|side| side.min(limits.most_side()));
        }
    }

    /// More pages for the device, where there are fewer than have rooms: half as many again.
    pub(super) fn hold(&mut self, limits: &PageLimits) {
        if self.count() > self.held {
            let grown = self.held + self.held / 2;
            self.held = grown.min(limits.most_pages()).max(self.count());
        }
    }

    /// So many rooms of one size, or none and why.
    pub(super) fn allocate_all(
        &mut self,
        size: [u32; 2],
        count: usize,
        limits: &PageLimits,
    ) -> Result<Vec<Room>, String> {
        let mut rooms = Vec::with_capacity(count);
        for _ in 0..count {
            match self.allocate(size, limits) {
                Ok(room) => rooms.push(room),
                Err(reason) => {
                    rooms.into_iter().for_each(|room| self.free(room));
                    return Err(reason);
                }
            }
        }
        Ok(rooms)
    }

    /// Takes a room of this size, on a page that has it, else on larger pages, else on a new one.
    fn allocate(&mut self, size: [u32; 2], limits: &PageLimits) -> Result<Room, String> {
        let side = limits.most_side();
        if size.iter().any(|&s| s > side) {
            let [x, y] = size;
            return Err(format!(
                "texels of {x} x {y}, and a page has at most {side} a side (max_texture_dimension_2d)"
            ));
        }
        loop {
            if let Some(room) = self.place(size) {
                return Ok(room);
            }
            self.grow(size, limits, side)?;
        }
    }

    fn place(&mut self, size: [u32; 2]) -> Option<Room> {
        let [x, y] = size.map(u32::cast_signed);
        let placed = (0..).zip(&mut self.pages).find_map(|(page, rooms)| {
            let room = rooms.allocate(size2(x, y))?;
            let corner = room.rectangle.min;
            Some(Room {
                place: Place {
                    page,
                    corner: [corner.x, corner.y].map(i32::cast_unsigned),
                },
                size,
                id: room.id,
            })
        });
        self.texels += placed.map_or(0, |_| texels(size));
        placed
    }

    /// Makes room for one of this size: it ends, since a page that is empty and as large has it.
    fn grow(&mut self, room: [u32; 2], limits: &PageLimits, most: u32) -> Result<(), String> {
        let wanted = power_of_two_within(limits.side.min(most));
        let [x, y] = self.size;
        let size = if x < room[0] || y < room[1] {
            [0, 1].map(|axis| self.size[axis].max(room[axis].next_power_of_two()))
        } else if self.pages.is_empty() {
            self.size
        } else if y <= x && y < wanted {
            [x, 2 * y]
        } else if x < wanted {
            [2 * x, y]
        } else {
            self.size
        };
        if size == self.size {
            return self.push(limits, wanted);
        }
        self.size = size;
        let [x, y] = size.map(u32::cast_signed);
        for page in &mut self.pages {
            page.grow(size2(x, y));
        }
        Ok(())
    }

    fn push(&mut self, limits: &PageLimits, side: u32) -> Result<(), String> {
        let most = limits.most_pages();
        if self.count() >= most {
            let [x, y] = self.size;
            return Err(format!(
                "texels do not fit {most} pages of {x} x {y} (max_texture_array_layers, at most \
                 {MAX_PAGES}; they can be larger where `page_side` is greater than {side})"
            ));
        }
        let [x, y] = self.size.map(u32::cast_signed);
        self.pages.push(AtlasAllocator::new(size2(x, y)));
        Ok(())
    }

    pub(super) fn free(&mut self, room: Room) {
        if let Some(page) = self.pages.get_mut(room.place.page as usize) {
            page.deallocate(room.id);
            self.texels -= texels(room.size);
        }
    }
}

/// Of a first page: one that a tenth is left of, up to `most` texels a side.
fn first_size(rooms: &[[u32; 2]], most: u32) -> [u32; 2] {
    let area: u64 = rooms.iter().copied().map(texels).sum();
    let area = area + area / 10;
    let largest = [0, 1].map(|axis| rooms.iter().map(|room| room[axis]).max().unwrap_or(1));
    let side = |side: u64, largest: u32| {
        let side = u32::try_from(side).unwrap_or(most).min(most);
        side.max(largest).max(1).next_power_of_two()
    };
    let x = side(area.isqrt() + 1, largest[0]);
    [x, side(area.div_ceil(u64::from(x)), largest[1])]
}

/// The largest power of two that is no larger; 1 of 0.
fn power_of_two_within(side: u32) -> u32 {
    1 << side.max(1).ilog2()
}

fn texels([x, y]: [u32; 2]) -> u64 {
    u64::from(x) * u64::from(y)
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: PageLimits = PageLimits {
        side: 512,
        device_side: 2048,
        device_layers: 3,
    };

    #[test]
    fn pages_grow_to_their_side_and_then_in_number() {
        let mut pages = Pages::default();
        let mut rooms = Vec::new();
        while let Ok(placed) = pages.allocate_all([250, 250], 1, &LIMITS) {
            rooms.extend(placed);
        }
        assert!((10..=12).contains(&rooms.len()), "{}", rooms.len());
        assert_eq!((pages.size(), pages.count()), ([512; 2], 3));
        let error = pages.allocate_all([500; 2], 1, &LIMITS).unwrap_err();
        assert!(error.contains("page_side") && error.contains("max_texture_array_layers"));
        for room in rooms {
            pages.free(room);
        }
        assert_eq!(pages.texels(), 0);
        pages.allocate_all([512; 2], 2, &LIMITS).unwrap();
        let texels = pages.texels();
        assert!(
            pages.allocate_all([500; 2], 2, &LIMITS).is_err(),
            "one fits"
        );
        assert_eq!(pages.texels(), texels, "all or none");
    }

    #[test]
    fn a_large_room_makes_larger_pages() {
        let mut pages = Pages::default();
        pages.begin([[100, 100]].into_iter(), &LIMITS);
        let small = pages.allocate_all([100, 100], 1, &LIMITS).unwrap();
        assert_eq!(pages.size(), [128; 2]);
        pages.allocate([900, 40], &LIMITS).unwrap();
        assert_eq!((pages.size(), pages.count()), ([1024, 256], 1));
        assert_eq!(small[0].place, Place::default());
        pages.allocate([2048, 2048], &LIMITS).unwrap();
        let error = pages.allocate([2049, 1], &LIMITS).unwrap_err();
        assert!(error.contains("max_texture_dimension_2d"), "{error}");
    }

    /// Rooms like those of drawings: most of one canvas image, a third with patches.
    #[test]
    fn a_thousand_rooms_lie_closely() {
        let mut state = 7_u32;
        let mut random = |most: u32| {
            state = state.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
            (state >> 12) % most
        };
        let mut sizes: Vec<[u32; 2]> = (0..1000)
            .map(|_| match random(10) {
                0..5 => [196, 130],
                5 => [130, 100],
                6 => [196, 66],
                7 => [130, 196],
                _ => [100 + random(500), 100 + random(500)],
            })
            .collect();
        let limits = PageLimits {
            side: 2048,
            device_side: 8192,
            device_layers: 256,
        };
        let mut pages = Pages::default();
        sizes.sort_by_key(|&[x, y]| std::cmp::Reverse([y, x]));
        pages.begin(sizes.iter().copied(), &limits);
        let rooms = sizes.iter().map(|&size| pages.allocate(size, &limits));
        let rooms: Vec<Room> = rooms.collect::<Result<_, _>>().unwrap();
        pages.hold(&limits);
        assert_eq!(pages.held(), pages.count());
        let held = texels(pages.size()) * u64::from(pages.count());
        assert!(
            10 * held < 13 * pages.texels(),
            "{held} for {}",
            pages.texels()
        );
        for (room, size) in rooms.iter().zip(&sizes) {
            let inside =
                [0, 1].map(|axis| room.place.corner[axis] + size[axis] <= pages.size()[axis]);
            assert_eq!(inside, [true; 2]);
        }
    }
}
