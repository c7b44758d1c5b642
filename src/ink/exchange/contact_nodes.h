#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/system/recycled.h"
#include "ink/exchange/contact_grid.h"
#include "ink/exchange/reservoir.h"

/// \file
/// Coupling of the tuft's cells to the nodes of the contact patch: the ink that each place of the patch receives.
/// Called by `stroke` for every stamp.
namespace tuft::ink {

/// A part of a bundle on the surface.
struct HairSample {
    std::uint32_t bundle = 0;
    Vec2 at{0};         ///< metres, in the stamp's (u, v)
    double along = 0;   ///< fraction of the tuft's length from the root
    double length = 0;  ///< metres, or any other measure common to all
};

/// Cells over each node, as fractions that sum to one.
struct NodeContact {
    struct Share {
        std::uint32_t cell = 0;
        float part = 0;
    };
    std::array<std::uint32_t, kNodes + 1> begin{};  ///< of node n: [begin[n], begin[n + 1])
    Recycled<Share> shares;

    std::span<const Share> of(int node) const {
        return std::span(shares).subspan(begin[node], begin[node + 1] - begin[node]);
    }
};

/// Amounts by node and plane, water last; film·m² unless said otherwise.
using NodeContents = std::array<Reservoir::Content, kNodes>;

/// Fractions of wet ink by plane and node, water last.
using NodeMixes = std::array<std::array<float, kNodes>, Reservoir::kPlanes>;

/// Source of a node without hair: the nearest node with hair, or first that of its own place across the patch. Ink
/// under a row of hair comes from the hair in front of it or behind it, not from what is beside it.
enum class NodesWithoutHair { nearest, column };

/// Computes the cells over each node. Each sample contributes to the four nodes round it by their hats, and to the
/// two cells of its bundle whose centres it lies between. A node without hair takes the cells of a node with hair,
/// by `rule`. Without any sample all nodes have the cells of `contact`.
NodeContact node_contact(const Reservoir& tuft, const ContactGrid& grid, std::span<const HairSample> samples,
                         const ContactCells& contact, NodesWithoutHair rule = NodesWithoutHair::nearest);

/// Returns true when the mixture differs between cells by more than rounding.
bool is_mixed(const Reservoir& tuft);

/// Returns the mixture at each node; its fractions sum to one. A node with empty cells has the mixture of the whole
/// tuft.
NodeMixes mixes_at(const Reservoir& tuft, const NodeContact& nodes);

/// Distributes an amount of a plane to a tile's nodes by their shares; evenly where all shares are 0.
void distribute(NodeContents& to, int plane, double amount, const std::array<double, kNodes>& shares,
                const HatBasis& hats);

/// Records the ink that a stamp's mixture leaves on a tile: each pigment at the nodes of its origin, then the water
/// mixed with it there.
class MixtureGiven {
  public:
    MixtureGiven(NodeContents& given, const NodeMixes& mixes, const HatBasis& hats)
        : given_(given), mixes_(mixes), hats_(hats) {}

    /// `amount` of a pigment in film·m², and its shares by node.
    void pigment(int plane, double amount, const std::array<double, kNodes>& shares);
    void water();

  private:
    NodeContents& given_;
    const NodeMixes& mixes_;
    const HatBasis& hats_;
    std::array<double, kNodes> strength_{}, came_{};  ///< of the mixture; film·m² of all pigments
};

/// Withdraws the given amounts: each plane from the cells over its node in proportion to their contents, the
/// shortfall from all cells that have it. While the tuft has enough of a plane, its total decreases by exactly the
/// sum.
void withdraw_contents(Reservoir& tuft, const NodeContents& given, const NodeContact& nodes);

/// Withdraws ink for each node, `amounts` in film·m², from its cells, each with its own mixture. With `from_afar`
/// the shortfall comes from all other cells, as in `take`. Returns the withdrawn amounts.
NodeContents draw(Reservoir& tuft, const std::array<double, kNodes>& amounts, const NodeContact& nodes,
                  const ContactCells& contact, bool from_afar = true);

/// Absorbs the ink lifted at each node into its cells. The excess is distributed as in `absorb` for the whole
/// contact.
void absorb(Reservoir& tuft, const NodeContents& lifted, const NodeContact& nodes, const ContactCells& contact);

}  // namespace tuft::ink
