#include "core/error.h"
#include "kaishu.h"

namespace tuft::samples {

namespace {

Glyph qi() {
    return {"七", {heng({75, 555}, {925, 410}, 84), shu_wan_gou({385, 130}, {395, 800}, {850, 790}, {850, 590}, 92)}};
}
Glyph shang() {
    return {"上",
            {shu_plain({425, 105}, {440, 835}, 94), short_heng({470, 455}, {755, 415}, 84),
             heng({60, 840}, {945, 800}, 90)}};
}
Glyph ba() {
    return {"八", {pie({395, 320}, {70, 800}, 92, 0.10), na({495, 190}, {800, 765}, {978, 780}, 118)}};
}
Glyph xia() {
    return {"下",
            {heng({60, 225}, {945, 175}, 86), shu_drop({455, 215}, {470, 925}, 98), dian({530, 400}, {750, 575}, 104)}};
}
Glyph ren() {
    return {"人", {pie({505, 115}, {55, 880}, 96, 0.12), na({480, 395}, {808, 825}, {975, 840}, 122)}};
}
Glyph sheng() {
    return {"生",
            {pie({275, 185}, {105, 545}, 80, 0.07), heng({235, 390}, {820, 345}, 74, 0.012),
             heng({215, 615}, {800, 575}, 74, 0.012), shu_plain({470, 70}, {485, 855}, 92),
             heng({65, 865}, {940, 830}, 86)}};
}
Glyph bu() {
    return {"步",
            {shu_plain({470, 60}, {480, 440}, 78), short_heng({515, 245}, {750, 212}, 68),
             shu_plain({270, 225}, {290, 450}, 72), heng({65, 455}, {940, 405}, 80),
             shu_gou({485, 478}, {497, 735}, {405, 672}, 78), dian_pie({320, 545}, {185, 740}, 78),
             pie({790, 505}, {150, 960}, 86, 0.12)}};
}
Glyph man() {
    return {"漫",
            {dian({110, 110}, {250, 235}, 78), dian({50, 335}, {180, 450}, 74), ti({85, 800}, {265, 490}, 76),
             shu_plain({405, 75}, {430, 325}, 54), heng_zhe({425, 105}, {795, 80}, {740, 330}, 58),
             short_heng({450, 205}, {735, 192}, 44), short_heng({450, 308}, {735, 298}, 44),
             shu_plain({315, 375}, {350, 575}, 54), heng_zhe({340, 405}, {925, 378}, {850, 570}, 56),
             shu_plain({490, 400}, {505, 545}, 46), shu_plain({680, 390}, {672, 540}, 46),
             short_heng({360, 560}, {855, 545}, 46), heng_pie({375, 660}, {790, 630}, {300, 945}, 62),
             na({420, 690}, {820, 905}, {985, 925}, 96)}};
}

}  // namespace

Glyph glyph(const std::string& character) {
    if (character == "七") return qi();
    if (character == "上") return shang();
    if (character == "八") return ba();
    if (character == "下") return xia();
    if (character == "人") return ren();
    if (character == "生") return sheng();
    if (character == "步") return bu();
    if (character == "漫") return man();
    throw Error("no strokes for the character " + character);
}

}  // namespace tuft::samples
