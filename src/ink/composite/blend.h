#pragma once

#include <optional>
#include <string_view>

/// \file
/// How user layers are shown over each other; composite.h computes it, the journal keeps it.
namespace tuft::ink {

/// How the films of a user layer meet the reflectance R of what lies below them, in each band.
/// Their height and roughness are the same in all three.
enum class Blend {
    normal,    ///< films that absorb and scatter, by Kubelka–Munk: R0 + T² R / (1 − R0 R), film by
               ///< film
    glaze,     ///< films that only absorb, as colour in clear varnish: their S is taken as 0, which
               ///< leaves R · exp(−2 Σ w K). Whites and other pigments that absorb nothing do not show
    multiply,  ///< a filter of the films' colour: R · R_white, R_white their reflectance over ideal
               ///< white. Nothing becomes lighter
};
/// "normal", "glaze", "multiply"; and back, nothing for any other word.
const char* name_of(Blend blend);
std::optional<Blend> blend_of(std::string_view name);

}  // namespace tuft::ink
