#include "app/widgets/manual_text.h"

#include "app/text/texts.h"

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
     "The strokes are the document: they can be painted again at another size, with another ink, on a revised "
     "model.\n"},
    {"Looking at the model",
     "* Middle or right button: turn. With Shift: move. With Ctrl, or the wheel: nearer and further. Ctrl and wheel: "
     "roll.\n"
     "* {front}, {right}, {top}: along an axis. {frame-all}: all of the model. {frame-cursor}: what is under the "
     "cursor. {parallel}: without perspective.\n"
     "* Look inside, in the panel: cuts the model open, so that the brush reaches the inner wall.\n"
     "* The lists at the upper right choose what is shown (glaze, clay, height of the ink, wetness, texels) and the "
     "light. Raking light shows the ridges of thick paint.\n"
     "* {atlas}: the atlas beside the model; a click on it turns the model there.\n"
     "* {panels}: folds the panels away.\n"},
    {"Brush and hand",
     "The rack holds goat, mixed and wolf hair from small to large; \"Tuft size\" makes any of them larger or "
     "smaller. \"All...\" lists every brush with a stroke that it painted.\n"
     "* {lighter} and {heavier} press less and more, {smaller} and {larger} change the size.\n"
     "* Arrow keys lean the holder, {upright} holds it upright.\n"
     "* A flat brush turns about its holder by Alt and wheel, {roll-anticlockwise} and {roll-clockwise}; \"Follow the "
     "stroke\" keeps its broad side across.\n"
     "* A pen gives its own pressure and tilt; \"Pen and holder\" shows the curve between its force and the depth "
     "of the brush.\n"
     "* \"Stabiliser\" draws the brush behind the cursor on a string, for long calm lines.\n"
     "* \"Symmetry\" paints mirrored and radial copies, each where the model really is.\n"
     "* {see-through} lets you see through the brush.\n"},
    {"Ink",
     "Choose an ink by its colour; its name and what it is made of show under the cursor.\n"
     "* \"Don't reload\": the brush runs dry as it paints, until you dip it. Else every stroke begins with a full "
     "brush.\n"
     "* \"Wet ink\": it flows, soaks in and mixes with wet ink under the brush. \"1 min\" and \"Dry\" let it flow and "
     "dry.\n"
     "* \"Another ink in the tip\": petals and leaves in one stroke.\n"
     "* {pick}: a click makes the pigments that lie there an ink of your own.\n"
     "* {palette}: a plate for mixing. Pour inks on it, stir them, paint with what the brush took up.\n"
     "* Recolour, in the Edit menu, shows what is painted in other inks without painting it again.\n"},
    {"Lines, curves and drawings",
     "* {line}: a straight line from press to release. Its ends can be pulled afterwards.\n"
     "* {curve}: click to set points, Enter paints. The wheel over a point changes the pressure there; Backspace takes "
     "one away.\n"
     "* {place}: writing and drawings (InkML, SVG) follow the cursor. The wheel sizes them, Shift and wheel turns "
     "them, a click places them.\n"
     "\"Drape\" bridges small grooves, panel gaps and scan noise; \"Wrap\" goes into each groove; \"Project\" goes "
     "straight, as seen from before the place. Strokes scale with the drawing.\n"
     "\"Edge\" beside the file's name lays copies along the shut line, edge or crease next to the cursor, \"Round\" "
     "round "
     "the model at its height, \"Curve\" along the curve whose points were set last: as many as fit, made to meet.\n"
     "* {write}: a text that you type follows the cursor, and a click writes it: in lines, in columns from right to "
     "left, round the model, or along the curve whose points were set last. Its characters are made stroke by stroke "
     "for the brush; they come with the program, or from fonts and folders of yours. "
     "A character can also be copied from a photo or a rubbing: its strokes are numbered over the picture, and a click "
     "on one reverses, joins, splits or removes it.\n"
     "A placed drawing is one group in the journal: hidden, moved, inked and deleted as one.\n"
     "It snaps to the plane of symmetry and level with other drawings, along the blue line; Ctrl places it freely. Its "
     "place can be typed.\n"},
    {"Layers, masks and filling",
     "* Strokes go onto the chosen layer. Layers are shown, faded, ordered and locked apart from each other.\n"
     "* {eraser} takes ink off the chosen layer, as deep as it is pressed.\n"
     "* {fill} covers the model, a part or a chart with ink.\n"
     "* {mask}: what faces one way, a chart, a group of the file or a lasso. The rest is veiled and takes no ink. "
     "\"Mask off\" paints everywhere again.\n"
     "* Parts are the groups of the model's file. The eye hides a part: the brush paints what lies behind it. The lock "
     "keeps its ink as it is. Chosen parts can be isolated and made of another material, such as glass.\n"},
    {"Journal and snapshots",
     "The journal lists all that was done, the newest on top.\n"
     "* A click chooses an entry, and its ink is highlighted on the model. Ctrl adds more, Shift takes a range, Esc "
     "chooses none.\n"
     "* The right button opens what can be done: hide, move, another brush, another ink, group, delete. The rest is "
     "painted again.\n"
     "* \"Take a snapshot\" keeps the work as it is now under a name. Later it can be compared with what is there, "
     "side by side or by a swipe, and restored.\n"
     "Restoring loses nothing: {undo} brings back what was there.\n"},
    {"Reference images",
     "\"Add an image...\" under References, or a picture dropped on the window, pins it over the view.\n"
     "* Drag it to move it, drag its corner or turn the wheel to size it.\n"
     "* The slider fades it, the eye hides it.\n"
     "Images are kept in the project.\n"},
    {"Saving and exporting",
     "* A project (.tuft) is one file with the model, the strokes and all that belongs to them. {save} gives it a "
     "name.\n"
     "* {export} writes GLB, glTF, OBJ, single maps, or the strokes alone. The list says which suits which program.\n"
     "* Decal sheets, in the File menu, lays the paint flat at true size, to be printed and cut. Film shows how it was "
     "painted.\n"
     "* After a crash or a power cut the work is offered at the next start, with every finished stroke.\n"
     "* Revised model, in the File menu, paints the strokes on a new version of the model and lists those that do not "
     "fit it.\n"},
};

}  // namespace

std::span<const ManualPage> manual_pages() {
    return kPages;
}

std::string manual_text(const ManualPage& page, Language language, const KeyTable& keys) {
    std::string text = language == Language::chinese ? chinese_manual_text(page.text) : page.text;
    for (std::size_t open; (open = text.find('{')) != std::string::npos;) {
        const std::size_t close = text.find('}', open);
        if (close == std::string::npos) break;
        const std::string word = text.substr(open + 1, close - open - 1);
        std::string key = "?";
        for (int i = 0; i < static_cast<int>(Action::count); ++i)
            if (word == word_of(static_cast<Action>(i))) key = name_of(keys.chord(static_cast<Action>(i)));
        text.replace(open, close + 1 - open, key.empty() ? "\xe2\x80\x93" : key);
    }
    return text;
}

}  // namespace tuft::app
