#pragma once

#include <functional>
#include <span>
#include <vector>

/// \file
/// What the importers' programs share (import_main.cpp, import_cad_main.cpp). Each reads one file from standard input,
/// opens no other, and writes a packed `io::FileScene`, or a line that begins with "fault: ", to standard output.
/// read_import.cpp starts them, and limits their time and memory.
namespace tuft::io {

/// Ends this process with what `import` makes of the bytes of standard input. It may open `n_files` files at a time,
/// which are in memory. Whatever a library prints is lost.
[[noreturn]] void run_importer(unsigned n_files, const std::function<std::vector<char>(std::span<const char>)>& import);

}  // namespace tuft::io
