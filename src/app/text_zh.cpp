#include <cstring>
#include <string>
#include <utility>

#include "app/ui.h"

/// Chinese texts of the interface. What is not here is shown in English.
namespace tuft::app {
namespace {

constexpr std::pair<const char*, const char*> kTexts[] = {
    {"File", "文件"}, {"Edit", "编辑"}, {"View", "视图"}, {"Help", "帮助"},
    {"Open...", "打开…"}, {"Save as...", "另存为…"}, {"Export...", "导出…"}, {"Close model", "关闭模型"}, {"Quit", "退出"},
    {"Undo", "撤销"}, {"Redo", "重做"}, {"Settings...", "设置…"}, {"Settings", "设置"},
    {"Frame all", "显示全部"}, {"Front", "前"}, {"Back", "后"}, {"Right", "右"}, {"Left", "左"}, {"Top", "上"}, {"Bottom", "下"},
    {"Parallel projection", "平行投影"}, {"See through the brush", "透视笔头"}, {"Side view of the tuft", "笔头侧视"},
    {"Glaze", "釉面"}, {"Clay", "泥胎"}, {"Flat colour", "纯色"}, {"Ink height", "墨层高度"}, {"Texel grid", "纹素网格"},
    {"Charts", "分片"}, {"Stretch", "拉伸"}, {"Studio light", "影棚光"}, {"Window light", "窗光"}, {"Raking light", "侧掠光"},
    {"How the model is shown", "模型的显示方式"}, {"Raking light shows the relief of the ink", "侧掠光显出墨的起伏"},
    {"Keys and mouse", "键盘与鼠标"}, {"Brush", "毛笔"}, {"Line", "直线"}, {"Ink", "墨色"}, {"Hand", "手"},
    {"Paint freely (B)", "自由书写 (B)"}, {"Straight on the screen, from press to release (L)", "屏幕上的直线，按下起，松开止 (L)"},
    {"Pressure", "笔压"}, {"Speed lightens", "行笔快则轻"}, {"Rest deepens", "驻笔则重"}, {"Stabiliser", "稳笔"},
    {"Pen softness", "压感曲线"}, {"Lean sideways", "左右倾斜"}, {"Lean away", "前后倾斜"},
    {"Carry ink over", "笔笔相续，墨尽再蘸"}, {"Dip", "蘸墨"}, {"Rinse", "洗笔"}, {"Comb", "舔笔"}, {"Wipe", "拭笔"},
    {"Layer", "图层"}, {"Mask", "遮罩"}, {"Fill", "铺色"},
    {"Symmetry", "对称"}, {"Copies round", "绕轴份数"}, {"Look inside", "剖视"}, {"Cut open", "剖开"}, {"What stays", "保留部分"},
    {"Across", "横向"}, {"Along", "纵向"}, {"From above", "自上"},
    {"Journal", "笔迹"}, {"Hide", "隐藏"}, {"Show", "显示"}, {"Delete", "删除"}, {"Stop", "停止"},
    {"Every stroke you paint is listed here, and can be hidden, changed or taken out later.", "每一笔都列在这里，日后可隐藏、更换或删除。"},
    {"Painting again", "重新绘制"}, {"Exporting", "正在导出"}, {"Force", "力"}, {"Moment", "弯矩"}, {"Depth", "深度"},
    {"Drop a model or a project anywhere on this window, or open one.", "把模型或项目拖到窗口里，或点打开。"},
    {"Recent projects", "最近的项目"}, {"Samples", "样品"}, {"Bowl", "碗"}, {"Car", "汽车"}, {"Cylinder", "圆筒"}, {"Plate", "盘"},
    {"Sheet", "纸"}, {"Sphere", "球"}, {"Thin plate", "薄板"}, {"Torus", "圆环"}, {"Vase", "瓶"},
    {"Open model", "打开模型"}, {"Opening", "正在打开"}, {"Cancel", "取消"}, {"Size", "尺寸"}, {"Triangles", "三角形"},
    {"Unit of the file", "文件单位"}, {"the format says so", "由格式规定"}, {"guessed from the size", "按尺寸推测"}, {"guessed", "推测"},
    {"Upward axis", "向上的轴"},
    {"Texels per side", "每边纹素"}, {"one texel is about %.2f mm", "一个纹素约 %.2f mm"}, {"Painted on", "底材"},
    {"Checked and repaired", "检查与修复"}, {"The mesh is sound; nothing had to be repaired.", "网格完好，无需修复。"},
    {"This many texels need more memory than is free.", "内存不足以容纳这么多纹素。"}, {"Unwrap and paint", "展开并绘制"},
    {"Unfinished work", "未完成的作品"}, {"Go on with it", "继续"}, {"Later", "以后"}, {"Discard", "丢弃"}, {"Model", "模型"}, {"Project", "项目"},
    {"not named yet", "尚未命名"},
    {"The program ended before this work was saved under a name. It is complete to the last finished stroke.",
     "程序在作品命名保存之前结束了。作品完整保留到最后写完的一笔。"},
    {"Export", "导出"}, {"For", "用于"}, {"Base colour", "颜色"}, {"Roughness", "粗糙度"}, {"Relief of the ink", "墨的起伏"},
    {"Choose a file...", "选择文件…"}, {"Print proof", "打样"}, {"Web", "网页"},
    {"Language", "语言"}, {"English", "English"}, {"Chinese", "中文"}, {"Colours", "配色"}, {"Dark", "深色"}, {"Light", "浅色"},
    {"Size of text and buttons", "文字与按钮大小"}, {"Mouse and hand", "鼠标与手"}, {"As in Blender", "同 Blender"}, {"As in Maya", "同 Maya"},
    {"Left-handed: tools on the right", "左手：工具放在右侧"}, {"Close", "关闭"},
    {"Left button", "左键"}, {"Paint", "绘制"}, {"Turn the view", "转动视图"}, {"Move the view", "平移视图"}, {"Nearer and further", "远近"},
    {"Middle, right, Alt + left", "中键、右键、Alt + 左键"}, {"Shift + middle", "Shift + 中键"}, {"Ctrl + middle, wheel", "Ctrl + 中键、滚轮"},
    {"Alt + left", "Alt + 左键"}, {"Alt + middle", "Alt + 中键"}, {"Alt + right, wheel", "Alt + 右键、滚轮"}, {"Ctrl + wheel", "Ctrl + 滚轮"},
    {"Roll the view", "倾转视图"}, {"Frame all, frame what is under the cursor", "显示全部、移到光标处"},
    {"1 3 7  (Ctrl: from behind)", "1 3 7（Ctrl：反面）"}, {"Front, right, top", "前、右、上"}, {"Parallel or perspective", "平行或透视"},
    {"Press less, press more", "轻一点、重一点"}, {"Arrow keys   \\", "方向键   \\"}, {"Lean the brush, hold it upright", "倾斜笔杆、扶正"},
    {"Brush, line", "毛笔、直线"}, {"Undo, redo", "撤销、重做"}, {"Esc while painting", "绘制中按 Esc"}, {"Take the stroke in hand back", "收回这一笔"},
    {"Open a model or project", "打开模型或项目"}, {"Save project as", "项目另存为"}, {"Export to", "导出到"}, {"Places", "位置"}, {"Home", "主目录"},
    {"Here", "当前目录"}, {"Up", "上一级"}, {"file name", "文件名"}, {"Open", "打开"}, {"Save", "保存"}, {"Replace", "替换"}, {"Replace it?", "替换原文件？"},
    {"There is no file of that name.", "没有这个文件。"}, {"Nothing can be written into this folder.", "这个文件夹不能写入。"},
    {"Nothing here that can be opened.", "这里没有可打开的文件。"}, {"Not kept on disk", "未存到磁盘"},
    {"Left: paint    Middle or right: turn    Shift+middle: move    Wheel: nearer    F1: all keys",
     "左键：绘制    中键或右键：转动    Shift+中键：平移    滚轮：远近    F1：全部按键"},
    {"Left: paint    Alt+left: turn    Alt+middle: move    Alt+right: nearer    F1: all keys",
     "左键：绘制    Alt+左键：转动    Alt+中键：平移    Alt+右键：远近    F1：全部按键"},
    {"The graphics driver was reset; the picture was made anew, and no stroke is lost.", "显卡驱动已重置；画面已重建，笔画无一丢失。"},
    {"Layers", "图层"}, {"Layer", "图层"}, {"Add a layer", "添加图层"}, {"Opacity", "不透明度"}, {"Higher", "上移"}, {"Lower", "下移"}, {"Remove", "删除"},
    {"Locked", "锁定"}, {"locked", "锁定"}, {"Seen or not", "显示或隐藏"}, {"Wetness", "湿度"},
    {"Eraser", "橡皮"}, {"Fill", "填充"}, {"erased", "擦除"}, {"Everything", "全部"}, {"Part", "部件"}, {"Chart", "分片"}, {"Thickness", "厚度"},
    {"Of the wet coat", "湿膜厚度"}, {"What the ink is laid over where you click", "单击处要覆盖的范围"}, {"Filling", "正在填充"},
    {"Takes ink off with the brush, as deep as it is pressed; a pen's other end does so too (E)", "用笔擦去墨，压得越重擦得越多；笔的另一端也是橡皮 (E)"},
    {"Lays the chosen ink over the whole model, a part or a chart where you click (G)", "在单击处把所选的墨铺满整个模型、部件或分片 (G)"},
    {"Wait a minute", "等一分钟"}, {"Dry", "晾干"}, {"Lets wet ink flow and dry for a minute", "让湿墨流动、干燥一分钟"},
    {"Waits until all ink is dry; what is painted then lies over it", "等墨全干；之后的笔画覆在上面"},
    {"Pen: from its force to the brush's depth", "笔：由压力到下笔深度"}, {"Drag its ends and its middle; a double click makes it straight", "拖动两端与中点；双击复原"},
    {"Keys...", "按键…"}, {"Mouse", "鼠标"}, {"Keys", "按键"}, {"Click a key to change it.", "单击按键即可更改。"}, {"press a key...", "请按键…"}, {"As shipped", "恢复默认"},
    {" has no key now.", " 现在没有按键。"}, {"Save as", "另存为"}, {"Delete the chosen stroke", "删除所选笔画"}, {"Place writing", "摆放字画"},
    {"Press less", "轻一点"}, {"Press more", "重一点"}, {"Lean to the left", "向左倾"}, {"Lean to the right", "向右倾"}, {"Lean away", "向外倾"}, {"Lean nearer", "向内倾"},
    {"Hold it upright", "扶正"}, {"Frame the cursor", "移到光标处"}, {"Next way of showing the model", "下一种显示方式"},
    {"Curve: paint it, remove a point, drop it", "曲线：绘制、去点、放弃"}, {"Maps", "贴图"}, {"Pictures", "图片"}, {"As painted", "与绘制时相同"}, {"None", "无"},
    {"One, as seen now", "一张，现在所见"}, {"24 all round", "环绕 24 张"}, {"72 all round", "环绕 72 张"}, {"Taking pictures", "正在拍照"},
    {"One GLB file; File > Import > glTF 2.0", "一个 GLB 文件；File > Import > glTF 2.0"}, {"One GLB file; drag it into the content browser", "一个 GLB 文件；拖进内容浏览器"},
    {"glTF with pictures beside it, for the glTFast package", "glTF 及旁附图片，供 glTFast 使用"}, {"A small GLB file for model viewers in a browser", "供网页查看器用的小 GLB 文件"},
    {"OBJ, MTL and PNG for colour printers and print shops", "OBJ、MTL 与 PNG，供彩色打印"}, {"The pen was unplugged; the mouse goes on.", "手写笔已拔出；鼠标继续可用。"},
    {"stretch", "拉伸"}, {"used", "利用率"}, {"%u charts", "%u 片"},
    {"Revised model...", "更换模型…"}, {"Revised model", "修订后的模型"}, {"Unwrap and repaint", "展开并重绘"}, {"Atlas beside the model", "并列显示贴图"},
    {"Move", "移动"}, {"Then drag it over the model with the left button", "然后用左键在模型上拖动"},
    {"Strokes that no longer fit", "不再贴合的笔画"}, {"These strokes do not touch the revised model anywhere. They stay in the journal.", "这些笔画完全碰不到修订后的模型，仍保留在笔迹中。"},
    {"Hide them", "全部隐藏"}, {"Keep them", "保留"}, {"The strokes are painted on the revised model; the former project is as it was.", "笔画已绘到修订后的模型上；原项目未变。"},
    {"coarser × 1.5", "稀 × 1.5"}, {"finer × 1.5", "密 × 1.5"},
    {"Place", "摆放"}, {"Lays writing or a drawing from a file where you click (T)", "把文件中的字或图摆到单击处 (T)"},
    {"Writing or drawing...", "字或图…"}, {"Writing or drawing to place", "要摆放的字或图"}, {"Width", "宽度"}, {"Turn", "转角"},
    {"Bend it round the surface", "沿表面弯曲"}, {"Brush and ink of the file", "用文件中的笔与墨"}, {"Laying it down", "正在落笔"},
    {"Wheel: size    Shift + wheel: turn    Click: lay it down", "滚轮：大小    Shift+滚轮：转角    单击：落笔"},
    {"Open a model first; then the writing can be placed on it.", "请先打开模型，再摆放字或图。"},
    {"Curve", "曲线"}, {"Along the line", "沿线运笔"}, {"Press down in", "起笔长度"}, {"Lift in", "收笔长度"}, {"Pace", "行笔速度"},
    {"Of the hand", "手的速度"}, {"Part of its length", "占全长的比例"}, {"Click to set points, Enter to paint, Esc to drop them.", "单击加点，Enter 绘制，Esc 放弃。"},
    {"Click to set points, drag to move them, the wheel over one changes its pressure, Enter paints (C)", "单击加点，拖动移点，滚轮改变该点笔压，Enter 绘制 (C)"},
    {"Straight as you see it, from press to release; Shift for steps of 15 degrees. Its ends can be moved afterwards (L)", "所见的直线，按下起，松开止；Shift 每 15 度一档；之后可移动两端 (L)"},
    {"The line does not lie on the model.", "线不在模型上。"},
    {"goat", "羊毫"}, {"mixed", "兼毫"}, {"wolf", "狼毫"}, {"other", "其他"}, {"More...", "更多…"}, {"Less", "收起"},
    {"wolf-small", "小狼毫"}, {"wolf-medium", "中狼毫"}, {"wolf-large", "大狼毫"}, {"goat-small", "小羊毫"}, {"goat-medium", "中羊毫"},
    {"goat-large", "大羊毫"}, {"mixed-small", "小兼毫"}, {"mixed-medium", "中兼毫"}, {"mixed-large", "大兼毫"},
    {"carbon", "松烟墨"}, {"cinnabar", "朱砂"}, {"cobalt", "青花"}, {"gamboge", "藤黄"}, {"indigo", "花青"}, {"iron-red", "铁红"},
    {"lamp-black", "油烟墨"}, {"bone-black", "骨黑"}, {"shell-white", "蛤粉"}, {"titanium-white", "钛白"},
    {"Pick", "吸色"}, {"Click: the pigments that lie there become an ink of their own, in the proportions they have (I)", "单击：该处的颜料按其比例成为一种新墨 (I)"},
    {"Says where strokes and fills may leave ink (M)", "限定笔画与填充可着墨之处 (M)"}, {"There is no ink here to pick up.", "此处无墨可取。"},
    {"Facing", "朝向"}, {"Chart mask", "分片"}, {"Lasso", "套索"}, {"Group", "组"}, {"How the mask is found", "如何圈定"}, {"Within", "夹角"}, {"Soft edge", "柔边"},
    {"Click on the model: what faces as it does there.", "单击模型：与该处朝向相近的部分。"}, {"Click on the model: the chart that lies there.", "单击模型：该处的分片。"},
    {"Also what lies behind", "包括背后的部分"}, {"Else only what is seen", "否则只含可见部分"}, {"Draw round a part of the model.", "在模型上圈出一块。"},
    {"The file of this model names no groups.", "此模型文件没有分组。"}, {"Click on the model: the group that lies there. Or choose it:", "单击模型取该处的组，或在此选择："},
    {"By itself", "单独"}, {"Added to the chosen one", "并入所选"}, {"Only within the chosen one", "仅在所选之内"}, {"Everywhere", "不限"}, {"Invert", "反转"},
    {"A mask of what this one leaves out", "由其余部分构成的遮罩"}, {"Remove mask", "删除遮罩"}, {"Strokes that keep to it stay as they are", "已有笔画不变"},
    {"Let go", "解除"}, {"Strokes leave ink everywhere again", "笔画又可处处着墨"}, {"Nothing of the model lies in this mask.", "模型没有任何部分在此遮罩内。"},
    {"Load...", "载入…"}, {"An ink from a file", "从文件载入墨"}, {"Keep...", "存墨…"}, {"Writes the ink in hand to a file, for other work", "把手中的墨写入文件，供别处使用"},
    {"Wet ink", "湿墨"}, {"It flows, soaks in and mixes with wet ink under the brush, which picks it up; it dries as you say", "墨会流动、渗入，并与笔下的湿墨相混；何时干由你定"},
    {"On a rag: the ink goes, as far as the brush is dipped", "在布上拭去墨，深度如下"}, {"How deep", "深度"},
    {"Part of the hair, from the tip. Wipe the tip and dip it into another ink: it is darker than the belly then", "由笔尖算起。拭净笔尖再蘸他墨，则尖深腹浅"},
    {"Another ink in the tip", "笔尖另蘸一墨"}, {"Every stroke begins with the chosen ink in the belly and another one in the tip: petals, leaves", "每笔笔腹用所选之墨，笔尖用另一墨：花瓣、叶"},
    {"Tip", "笔尖"}, {"How far up the hair it goes", "蘸到多高"}, {"Recolour...", "改色…"}, {"Recolour", "改色"}, {"as", "显示为"}, {"Recipe", "配方"}, {"Its pigments", "所含颜料"},
    {"Shows what is painted in other inks, or on another material, without painting it anew", "不重画而以他墨或他材显示"},
    {"Pigment amounts stay as they were painted; only what they look like changes.", "颜料的量不变，只改显示的颜色。"}, {"Nothing is painted yet.", "还没有画。"},
    {"Material", "材质"}, {"painted on", "画于"}, {"Back to the tools", "回到工具"}, {"Add a pigment...", "加颜料…"}, {"Part of the wet ink; the rest is water", "占湿墨的比例，其余为水"},
    {"Changes with it:", "随之改变："}, {"Open an ink", "打开墨"}, {"Save the ink as", "墨另存为"}, {"mixture", "调和墨"},
    {"porcelain", "瓷"}, {"bisque", "素坯"}, {"clay", "泥"}, {"primed-metal", "底漆金属"}, {"rice-paper", "宣纸"},
};

}  // namespace

const char* chinese_text(const char* english) {
    for (const auto& [from, to] : kTexts)
        if (std::strcmp(from, english) == 0) return to;
    return nullptr;
}

std::string all_chinese_text() {
    std::string all;
    for (const auto& [from, to] : kTexts) all += to;
    return all;
}

}  // namespace tuft::app
