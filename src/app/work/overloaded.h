#pragma once

namespace tuft::app {

/// Several lambdas as one, for `std::visit`.
template <class... Fs>
struct Overloaded : Fs... {
    using Fs::operator()...;
};
template <class... Fs>
Overloaded(Fs...) -> Overloaded<Fs...>;  // clang 14 does not find it by itself

}  // namespace tuft::app
