#include "atlas/charts/refine_parameterisation.h"

#include <algorithm>
#include <numeric>

#include "atlas/charts/phase_progress.h"
#include "atlas/charts/tasks.h"
#include "atlas/flatten/flatten.h"

namespace tuft::atlas {

void refine_parameterisation(CutMesh& cut, const ChartOptions& options, const ProgressFn& progress) {
    std::vector<std::uint32_t> order(cut.charts.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto size = [&](std::uint32_t c) { return cut.charts[c].mesh.faces.size(); };
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return size(a) > size(b); });
    double all = 0;
    for (const std::uint32_t c : order) all += double(size(c));
    PhaseProgress phase(progress, "polish", all);
    run_tasks(order.size(), [&](std::size_t i) {
        FlatChart& chart = cut.charts[order[i]];
        const double n = double(chart.mesh.faces.size());
        TaskProgress part(phase, n);
        ArapOptions arap_options;
        arap_options.on_step = [&] { part.advance(n / arap_options.iterations); };
        std::vector<Vec2> uv = chart.uv;
        arap(chart.mesh, uv, arap_options);
        scale_to_area(chart.mesh, uv);
        const FlatCheck check = check_flat(chart.mesh, uv, options.gap);
        part.finish();
        if (!check.sound() || check.l2 > chart.l2 || check.stretch_999 > options.largest ||
            check.linf > std::max(options.worst, chart.worst))
            return;
        chart.uv = std::move(uv);
        chart.l2 = check.l2;
        chart.worst = check.linf;
    });
}

}  // namespace tuft::atlas
