#pragma once

#include <optional>
#include <string_view>

/// \file
/// Blend modes of user layers. composite.h computes them; the journal of `stroke` stores them.
namespace tuft::ink {

/// Blend of the films of a user layer with the reflectance R below, in each band. Height and roughness are the same
/// in all three.
enum class Blend {
    normal,  ///< films absorb and scatter (Kubelka–Munk): R0 + T² R / (1 − R0 R), film by film
    /// Films only absorb, like colour in clear varnish: S = 0, R · exp(−2 Σ w K). Pigments without absorption,
    /// such as whites, are invisible.
    glaze,
    /// Filter of the films' colour: R · R_white, with R_white their reflectance over ideal white; never lightens.
    multiply,
};
/// "normal", "glaze", "multiply"; and back, nothing for any other word.
const char* name_of(Blend blend);
std::optional<Blend> blend_of(std::string_view name);

}  // namespace tuft::ink
