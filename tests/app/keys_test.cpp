#include "app/input/keys.h"

#include <gtest/gtest.h>

#include "app/input/events.h"

namespace tuft::app {
namespace {

TEST(Keys, EveryShippedChordHasANameThatIsReadBackAndNoTwoAreTheSame) {
    const KeyTable keys;
    for (int i = 0; i < static_cast<int>(Action::count); ++i) {
        const Chord chord = keys.chord(static_cast<Action>(i));
        const auto back = chord_of(name_of(chord));
        ASSERT_TRUE(back) << title_of(static_cast<Action>(i));
        EXPECT_EQ(*back, chord);
        EXPECT_EQ(keys.find(chord), static_cast<Action>(i));
    }
}

TEST(Keys, AKeyGivenToAnotherActionLeavesTheFirstWithout) {
    KeyTable keys;
    EXPECT_EQ(keys.assign(Action::curve, *chord_of("B")), Action::brush);
    EXPECT_EQ(keys.find(*chord_of("B")), Action::curve);
    EXPECT_EQ(keys.find(*chord_of("C")), std::nullopt);
    EXPECT_EQ(keys.chord(Action::brush).key, 0);
    EXPECT_FALSE(keys.shipped());
    KeyTable other;
    for (const auto& [word, chord] : keys.changes()) other.restore(word, chord);
    EXPECT_EQ(other.changes(), keys.changes());
    EXPECT_EQ(other.find(*chord_of("B")), Action::curve);
}

TEST(Keys, NonsenseInTheSettingsChangesNothing) {
    KeyTable keys;
    keys.restore("fly", "B");
    keys.restore("brush", "Hyper+Q");
    keys.restore("brush", "");
    EXPECT_TRUE(keys.shipped());
    EXPECT_FALSE(chord_of("F26"));
    EXPECT_FALSE(chord_of("Ctrl+"));
    EXPECT_EQ(chord_of("Ctrl++")->key, '+');
}

}  // namespace
}  // namespace tuft::app
