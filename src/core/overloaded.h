#pragma once

/// \file
/// One function for each alternative of a variant.
namespace tuft {

/// Functions for `std::visit`, one for each alternative of a variant. One that is missing does not compile.
template <class... Functions>
struct Overloaded : Functions... {
    using Functions::operator()...;
};
/// Clang deduces it for an aggregate only from release 17 on.
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

}  // namespace tuft
