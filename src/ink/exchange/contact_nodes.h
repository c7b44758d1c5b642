#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ink/exchange/contact_grid.h"
#include "ink/exchange/reservoir.h"

/// Which hair gives its ink where: cells of the tuft and nodes of the contact patch.
namespace tuft::ink {

/// A cluster of a bundle that lies on the surface.
struct HairSample {
    std::uint32_t bundle = 0;
    Vec2 at{0};         ///< metres, in the stamp's (u, v)
    double along = 0;   ///< part of the tuft's length from the root
    double length = 0;  ///< metres, or any other measure common to all
};

/// The cells over each node, as parts that sum to one.
struct NodeContact {
    struct Share {
        std::uint32_t cell = 0;
        float part = 0;
    };
    std::array<std::uint32_t, kNodes + 1> begin{};  ///< of node n: [begin[n], begin[n + 1])
    std::vector<Share> shares;

    std::span<const Share> of(int node) const {
        return std::span(shares).subspan(begin[node], begin[node + 1] - begin[node]);
    }
};

/// Amounts by node and plane, water last; film·m² unless said otherwise.
using NodeContents = std::array<Reservoir::Content, kNodes>;

/// Parts of wet ink by plane and node, water last.
using NodeMixes = std::array<std::array<float, kNodes>, Reservoir::kPlanes>;

/// Each sample counts for the four nodes round it by their hats, and for the two cells of its
/// bundle whose middles it lies between. A node without hair has what the nearest one has; without
/// any sample all have the cells of `touch`.
NodeContact node_contact(const Reservoir& tuft, const ContactGrid& grid, std::span<const HairSample> samples,
                         const ContactCells& touch);

/// Whether what would leave differs from cell to cell, by more than rounding makes.
bool is_mixed(const Reservoir& tuft);

/// What would leave at each node; its parts sum to one. Where nothing is left over a node, the
/// mixture of the whole tuft.
NodeMixes mixes_at(const Reservoir& tuft, const NodeContact& nodes);

/// Deals an amount of a plane out to a tile's nodes by their shares, evenly where none has any.
void deal(NodeContents& to, int plane, double amount, const std::array<double, kNodes>& shares, const HatBasis& hats);

/// Books what a stamp's mixture leaves on a tile: each pigment to the nodes that it came from, and
/// then the water that was mixed with it there.
class MixtureGiven {
  public:
    MixtureGiven(NodeContents& given, const NodeMixes& mixes, const HatBasis& hats)
        : given_(given), mixes_(mixes), hats_(hats) {}

    /// `amount` in film·m² of a pigment, and what of it came from each node of the hats.
    void pigment(int plane, double amount, const std::array<double, kNodes>& shares);
    void water();

  private:
    NodeContents& given_;
    const NodeMixes& mixes_;
    const HatBasis& hats_;
    std::array<double, kNodes> strength_{}, came_{};  ///< of the mixture; film·m² of all pigments
};

/// Takes what was given at the nodes, each plane from the cells over its node in proportion to what
/// they have of it, and what they lack from all cells that have it. As long as the tuft has so much
/// of a plane, its total falls by just the sum.
void spend(Reservoir& tuft, const NodeContents& given, const NodeContact& nodes);

/// Takes ink for each node, `amounts` in film·m², from its cells, of each its own mixture; what they
/// lack comes as from `take` if it may come `from_afar`, from hair that is not over the node.
NodeContents draw(Reservoir& tuft, const std::array<double, kNodes>& amounts, const NodeContact& nodes,
                  const ContactCells& touch, bool from_afar = true);

/// Takes up what was lifted at each node into its cells; what they have no room for goes as in the
/// `absorb` for the whole touch.
void absorb(Reservoir& tuft, const NodeContents& lifted, const NodeContact& nodes, const ContactCells& touch);

}  // namespace tuft::ink
