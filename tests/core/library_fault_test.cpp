#include "core/files/library_fault.h"

#include <gtest/gtest.h>

#include <string>

namespace tuft {
namespace {

TEST(LibraryFault, HasAKindOfItsOwnAndTheLibrarysWordsBehindIt) {
    // Of libpng, OpenEXR, Assimp, nlohmann::json, the operating system.
    for (const char* words : {"PNG read error: \"Read Error\"", "Error reading pixel data. Unexpected end of file.",
                              "FBX-Tokenize (offset 0x1b) cannot read string, length is out of data",
                              "parse error at line 1, column 12: syntax error - unexpected end of input"})
        EXPECT_EQ(library_fault(words), Message("it ends too early")) << words;
    EXPECT_EQ(library_fault("write failed: No space left on device").text(), "No space left on device");
    EXPECT_EQ(library_fault("could not open: Permission denied").text(), "Permission denied");
    EXPECT_EQ(library_fault("std::bad_alloc").text(), "there is not enough memory");
    EXPECT_EQ(library_fault("No suitable reader found for the file format of file \"x\".").text(),
              "its format is unknown (No suitable reader found for the file format of file \"x\")");
    EXPECT_EQ(library_fault("Unsupported compression 7\n").text(),
              "it uses what cannot be read here (Unsupported compression 7)");
    EXPECT_EQ(library_fault("bad CRC in chunk").text(), "it is damaged (bad CRC in chunk)");
    EXPECT_EQ(library_fault("").text(), "it is damaged");
}

TEST(LibraryFault, StaysOnOneLineAndShort) {
    const std::string text = library_fault("first\nsecond {} " + std::string(5000, 'x')).text();
    EXPECT_EQ(text.find('\n'), std::string::npos);
    EXPECT_LT(text.size(), 250u);
    EXPECT_NE(text.find("{}"), std::string::npos) << "words from elsewhere are no format";
}

TEST(LibraryFault, OfTomlSaysWhatIsWrong) {
    EXPECT_EQ(toml_fault("Error while parsing array: encountered end-of-file").text(), "it ends too early");
    EXPECT_EQ(toml_fault("Error while parsing key-value pair: cannot redefine existing integer 'a'").text(),
              "a name is given twice (Error while parsing key-value pair: cannot redefine existing integer 'a')");
    EXPECT_EQ(toml_fault("Error while parsing value: expected a value, saw '='").text(),
              "this is not TOML (Error while parsing value: expected a value, saw '=')");
}

}  // namespace
}  // namespace tuft
