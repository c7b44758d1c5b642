#include "app/panels/manual_text.h"

namespace tuft::app {
namespace {

constexpr ManualPage kPages[] = {
    {"First steps",
     "Open a model, or take one of the samples. The dialog says how large it is and what was repaired; then it is "
     "unwrapped, and you can paint.\n"
     "* Drag with the left button: the brush paints where it touches the surface.\n"
     "* Drag with the middle or right button: the model turns. The wheel goes nearer.\n"
     "* {undo} takes the last stroke back, {redo} brings it again.\n"
     "* {save} gives the work a name. Every stroke is on disk when the button is up, also before that.\n"
     "The strokes are the document: they can be painted again at another size, with another ink, on a revised model.\n",
     "入门",
     "打开一个模型，或取一个样品。对话框说明它有多大、修复了什么；然后展开，即可绘制。\n"
     "* 用左键拖动：笔触到曲面之处即着墨。\n"
     "* 用中键或右键拖动：转动模型。滚轮拉近。\n"
     "* {undo} 收回最后一笔，{redo} 再画上。\n"
     "* {save} 为作品命名。即使尚未命名，每一笔松开时也已存到磁盘。\n"
     "笔画就是作品：可以换尺寸、换墨，或在修订后的模型上重新绘制。\n"},
    {"Looking at the model",
     "* Middle or right button: turn. With Shift: move. With Ctrl, or the wheel: nearer and further. Ctrl and wheel: "
     "roll.\n"
     "* {front}, {right}, {top}: along an axis. {frame-all}: all of the model. {frame-cursor}: what is under the "
     "cursor. {parallel}: without perspective.\n"
     "* Look inside, in the panel: cuts the model open, so that the brush reaches the inner wall.\n"
     "* The lists at the upper right choose what is shown (glaze, clay, height of the ink, wetness, texels) and the "
     "light. Raking light shows the ridges of thick paint.\n"
     "* {atlas}: the atlas beside the model; a click on it turns the model there.\n"
     "* {panels}: folds the panels away.\n",
     "查看模型",
     "* 中键或右键：转动。加 Shift：平移。加 Ctrl 或用滚轮：远近。Ctrl 加滚轮：倾转。\n"
     "* {front}、{right}、{top}：沿轴观看。{frame-all}：整个模型。{frame-cursor}：光标处。{parallel}：无透视。\n"
     "* 面板中的“剖视”：剖开模型，笔可及内壁。\n"
     "* 右上角的列表选择显示方式（釉面、泥胎、墨层高度、湿度、纹素）与光线。侧掠光显出厚墨的起伏。\n"
     "* {atlas}：贴图与模型并列；单击贴图，模型转到该处。\n"
     "* {panels}：收起面板。\n"},
    {"Brush and hand",
     "The rack holds goat, mixed and wolf hair from small to large; \"Tuft size\" makes any of them larger or "
     "smaller.\n"
     "* {lighter} and {heavier} press less and more, {smaller} and {larger} change the size.\n"
     "* Arrow keys lean the holder, {upright} holds it upright.\n"
     "* A pen gives its own pressure and tilt; \"More...\" shows the curve between its force and the depth of the "
     "brush.\n"
     "* \"Stabiliser\" draws the brush behind the cursor on a string, for long calm lines.\n"
     "* \"Symmetry\" paints mirrored and radial copies, each where the model really is.\n"
     "* {see-through} lets you see through the brush.\n",
     "笔与手",
     "笔架上有羊毫、兼毫、狼毫，由小到大；“笔径”可任意放大缩小。\n"
     "* {lighter} 与 {heavier} 减轻与加重笔压，{smaller} 与 {larger} 改变大小。\n"
     "* 方向键使笔杆倾斜，{upright} 扶正。\n"
     "* 手写笔自有压力与倾角；“更多…”显示压力与下笔深度之间的曲线。\n"
     "* “稳笔”以线牵笔，画长而平稳的线。\n"
     "* “对称”画出镜像与绕轴的副本，各按该处的模型接触。\n"
     "* {see-through}：透视笔头。\n"},
    {"Ink",
     "Choose an ink by its colour; its name and what it is made of show under the cursor.\n"
     "* \"Don't reload\": the brush runs dry as it paints, until you dip it. Else every stroke begins with a full "
     "brush.\n"
     "* \"Wet ink\": it flows, soaks in and mixes with wet ink under the brush. \"Wait a minute\" and \"Dry\" let it "
     "go its way.\n"
     "* \"Another ink in the tip\": petals and leaves in one stroke.\n"
     "* {pick}: a click makes the pigments that lie there an ink of your own.\n"
     "* {palette}: a plate for mixing. Pour inks on it, stir them, paint with what the brush took up.\n"
     "* Recolour, in the Edit menu, shows what is painted in other inks without painting it again.\n",
     "墨",
     "按颜色选墨；名称与成分显示在光标处。\n"
     "* “笔笔相续，不另蘸墨”：笔越写越干，直到再蘸。否则每笔开始都是满墨。\n"
     "* “湿墨”：流动、渗入，并与笔下的湿墨相混。“等一分钟”与“晾干”任其自然。\n"
     "* “笔尖另蘸一墨”：一笔画出花瓣与叶。\n"
     "* {pick}：单击，该处的颜料成为自己的墨。\n"
     "* {palette}：调墨的瓷盘。倒墨、调和，再用笔中所蘸的墨绘制。\n"
     "* 编辑菜单中的“换色”以其他墨显示已画的内容，无需重画。\n"},
    {"Lines, curves and drawings",
     "* {line}: a straight line from press to release. Its ends can be pulled afterwards.\n"
     "* {curve}: click to set points, Enter paints. The wheel over a point changes the pressure there; Backspace takes "
     "one away.\n"
     "* {place}: writing and drawings (InkML, SVG) follow the cursor. The wheel sizes them, Shift and wheel turns "
     "them, a click places them.\n"
     "\"Drape\" bridges small grooves, panel gaps and scan noise; \"Wrap\" goes into each groove; \"Project\" goes "
     "straight, as seen from before the place. Strokes scale with the drawing.\n"
     "A placed drawing is one group in the journal: hidden, moved, inked and deleted as one.\n",
     "直线、曲线与图稿",
     "* {line}：按下起，松开止的直线。两端之后可拖动。\n"
     "* {curve}：单击加点，Enter 绘制。在点上转滚轮改变该处笔压；Backspace 去掉一点。\n"
     "* {place}：字与图（InkML、SVG）随光标而动。滚轮改大小，Shift 加滚轮转角，单击摆放。\n"
     "“铺覆”跨过小沟槽、板缝与扫描噪声；“包裹”深入每道沟槽；“投影”从正前方直投。笔画随图缩放。\n"
     "摆好的图在笔迹中是一组：整组隐藏、移动、换墨、删除。\n"},
    {"Layers, masks and filling",
     "* Strokes go onto the chosen layer. Layers are shown, faded, ordered and locked apart from each other.\n"
     "* {eraser} takes ink off the chosen layer, as deep as it is pressed.\n"
     "* {fill} lays ink over the model, a part or a chart.\n"
     "* {mask}: what faces one way, a chart, a group of the file or a lasso. The rest is veiled and takes no ink. "
     "\"Mask off\" paints everywhere again.\n",
     "图层、遮罩与填充",
     "* 笔画落在所选图层。图层可分别显示、淡化、排序与锁定。\n"
     "* {eraser} 擦去所选图层的墨，压得越重擦得越多。\n"
     "* {fill} 把墨铺满模型、部件或分片。\n"
     "* {mask}：朝同一方向之处、分片、文件中的组，或套索。其余蒙上薄纱，不着墨。“关闭遮罩”后又可处处着墨。\n"},
    {"Journal and snapshots",
     "The journal lists all that was done, the newest on top.\n"
     "* A click chooses an entry, and its ink is highlighted on the model. Ctrl adds more, Shift takes a range, Esc "
     "chooses none.\n"
     "* The right button opens what can be done: hide, move, another brush, another ink, group, delete. The rest is "
     "painted again.\n"
     "* \"Take a snapshot\" keeps the work as it is now under a name. Later it can be compared with what is there, "
     "side by side or by a swipe, and restored.\n"
     "Restoring loses nothing: {undo} brings back what was there.\n",
     "笔迹与快照",
     "笔迹列出做过的一切，最新的在上。\n"
     "* 单击选取一项，其墨在模型上高亮。Ctrl 加选，Shift 选一段，Esc 不选。\n"
     "* 右键打开菜单：隐藏、移动、换笔、换墨、编组、删除。其余重新绘制。\n"
     "* “拍快照”以名称保存现在的作品。之后可与现状并排或滑动比较，也可恢复。\n"
     "恢复不会丢失任何东西：{undo} 回到原状。\n"},
    {"Reference images",
     "\"Add an image...\" under References, or a picture dropped on the window, pins it over the view.\n"
     "* Drag it to move it, drag its corner or turn the wheel to size it.\n"
     "* The slider fades it, the eye hides it.\n"
     "Images are kept in the project.\n",
     "参考图",
     "在“参考图”下点“添加图片…”，或把图片拖到窗口里，即钉在视图上。\n"
     "* 拖动可移动，拖角或转滚轮改大小。\n"
     "* 滑块改变透明度，眼睛隐藏。\n"
     "图片保存在项目中。\n"},
    {"Saving and exporting",
     "* A project (.tuft) is one file with the model, the strokes and all that belongs to them. {save} gives it a "
     "name.\n"
     "* {export} writes GLB, glTF, OBJ, single maps, or the strokes alone. The list says which suits which program.\n"
     "* After a crash or a power cut the work is offered at the next start, with every finished stroke.\n"
     "* Revised model, in the File menu, paints the strokes on a new version of the model and lists those that do not "
     "fit it.\n",
     "保存与导出",
     "* 项目（.tuft）是一个文件，含模型、笔画及所属的一切。{save} 为它命名。\n"
     "* {export} 写出 GLB、glTF、OBJ、单张贴图，或只有笔画。列表说明各适合什么程序。\n"
     "* 程序或电源中断后，下次启动时可继续，写完的每一笔都在。\n"
     "* 文件菜单中的“更换模型”把笔画绘到新版模型上，并列出不再贴合的笔画。\n"},
};

}  // namespace

std::span<const ManualPage> manual_pages() {
    return kPages;
}

std::string manual_text(const ManualPage& page, Language language, const KeyTable& keys) {
    std::string text = language == Language::chinese ? page.chinese_text : page.text;
    for (std::size_t open; (open = text.find('{')) != std::string::npos;) {
        const std::size_t close = text.find('}', open);
        if (close == std::string::npos) break;
        const std::string word = text.substr(open + 1, close - open - 1);
        std::string key = "?";
        for (int i = 0; i < static_cast<int>(Act::count); ++i)
            if (word == word_of(static_cast<Act>(i))) key = name_of(keys.chord(static_cast<Act>(i)));
        text.replace(open, close + 1 - open, key.empty() ? "\xe2\x80\x93" : key);
    }
    return text;
}

}  // namespace tuft::app
