//!use core/layout
// What the last item of an entry makes of a winding.

fn vtex_winding_fills(tail: u32, winding: i32) -> bool {
    let base = bitcast<i32>(tail << VTEX_ITEM_BASE_LEFT) >> VTEX_ITEM_BASE_RIGHT;
    let total = winding + base;
    return select(total != 0, (total & 1) != 0, (tail & VTEX_ITEM_EVEN_ODD_BIT) != 0u);
}
