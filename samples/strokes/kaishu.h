#pragma once

#include "hand.h"

/// The strokes of regular script (kaishu), as the hand makes them. Points and widths in
/// thousandths of the character square; `w` is the width of the stroke's body.
namespace tuft::samples {

/// 横, left to right: a cut entry from above, a body that thins towards the middle and
/// bows up a little, a shoulder to which the tip lifts, the belly pressed down beside it and drawn to the foot.
Stroke heng(Vec2 from, Vec2 to, double w, double bow = 0.02);
/// A short 横 that only lands and swells, with the same shoulder, as in 上 or 步.
Stroke short_heng(Vec2 from, Vec2 to, double w);
/// 竖 ending in a dew drop (垂露): it narrows, swells, and is lifted as it comes to rest.
Stroke shu_drop(Vec2 from, Vec2 to, double w, double bow = 0.0);
/// 竖 ending in a needle (悬针): lifted while it goes down.
Stroke shu_needle(Vec2 from, Vec2 to, double w);
/// 竖 that ends on another stroke: lifted where it stands.
Stroke shu_plain(Vec2 from, Vec2 to, double w);
/// 竖钩: down, rest, and flick to the upper left.
Stroke shu_gou(Vec2 from, Vec2 to, Vec2 hook, double w);
/// 竖弯钩: down, round to the right, and flick up.
Stroke shu_wan_gou(Vec2 from, Vec2 bend, Vec2 to, Vec2 hook, double w);
/// 撇: pressed at its head, swept to the lower left and lifted off. `sag` bends it.
Stroke pie(Vec2 from, Vec2 to, double w, double sag = 0.12);
/// 捺: thin and rising in pressure, pressed at the foot, slid out level and lifted off.
Stroke na(Vec2 from, Vec2 foot, Vec2 to, double w);
/// 点: lands light, presses down to the right, and comes back.
Stroke dian(Vec2 from, Vec2 to, double w);
/// A short 撇 that counts as a dot.
Stroke dian_pie(Vec2 from, Vec2 to, double w);
/// 提: pressed and flicked to the upper right.
Stroke ti(Vec2 from, Vec2 to, double w);
/// 横折: across, a shoulder, and down.
Stroke heng_zhe(Vec2 from, Vec2 corner, Vec2 to, double w);
/// 横撇: across, a shoulder, and swept to the lower left.
Stroke heng_pie(Vec2 from, Vec2 corner, Vec2 to, double w);

/// The eight characters of the sample bowls, each on its square.
Glyph glyph(const std::string& character);

}  // namespace tuft::samples
