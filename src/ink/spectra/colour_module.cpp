// The module `tuft_colour`: the only code that sees OpenColorIO.
#include "ink/spectra/colour_module.h"

#include <OpenColorIO/OpenColorIO.h>

#include <exception>
#include <string>

namespace tuft::ink {
namespace {

namespace ocio = OCIO_NAMESPACE;

void append(ocio::GroupTransform& group, const char* built_in, ocio::TransformDirection direction) {
    const ocio::BuiltinTransformRcPtr transform = ocio::BuiltinTransform::Create();
    transform->setStyle(built_in);
    transform->setDirection(direction);
    group.appendTransform(transform);
}

/// The built-in transforms that lead from sRGB to the space. Display P3 has the primaries of P3-D65.
ocio::GroupTransformRcPtr from_srgb(ColourSpace space) {
    const ocio::GroupTransformRcPtr group = ocio::GroupTransform::Create();
    if (space == ColourSpace::acescg) {
        append(*group, "UTILITY - ACES-AP1_to_LINEAR-REC709_BFD", ocio::TRANSFORM_DIR_INVERSE);
    } else if (space == ColourSpace::display_p3) {
        append(*group, "DISPLAY - CIE-XYZ-D65_to_sRGB", ocio::TRANSFORM_DIR_INVERSE);
        append(*group, "DISPLAY - CIE-XYZ-D65_to_G2.6-P3-D65", ocio::TRANSFORM_DIR_FORWARD);
    }
    return group;
}

/// The one matrix of a chain without loss. Curves at its ends are those of stored values. A chain of another version of
/// the library that has no matrix, several or offsets is refused.
Matrix3 matrix_of(const ocio::GroupTransformRcPtr& chain, ocio::TransformDirection direction) {
    const ocio::ConstProcessorRcPtr processor = ocio::Config::CreateRaw()->getProcessor(chain, direction);
    const ocio::GroupTransformRcPtr parts =
        processor->getOptimizedProcessor(ocio::OPTIMIZATION_LOSSLESS)->createGroupTransform();
    Matrix3 found{};
    int n_matrices = 0;
    for (int part = 0; part < parts->getNumTransforms(); ++part) {
        const auto matrix = ocio::DynamicPtrCast<ocio::MatrixTransform>(parts->getTransform(part));
        if (!matrix) continue;
        std::array<double, 16> rows{};
        std::array<double, 4> offsets{};
        matrix->getMatrix(rows.data());
        matrix->getOffset(offsets.data());
        if (matrix->getDirection() != ocio::TRANSFORM_DIR_FORWARD || offsets != std::array<double, 4>{})
            throw ocio::Exception("a conversion between colour spaces is no plain matrix");
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j) found[i][j] = rows[4 * i + j];
        ++n_matrices;
    }
    if (n_matrices != 1) throw ocio::Exception("a conversion between colour spaces is not one matrix");
    return found;
}

}  // namespace
}  // namespace tuft::ink

extern "C" __attribute__((visibility("default"))) const char* tuft_colour_matrices(tuft::ink::ColourSpace space,
                                                                                   tuft::ink::ColourMatrices& out) {
    namespace ink = tuft::ink;
    try {
        const auto chain = ink::from_srgb(space);
        out.from_srgb = ink::matrix_of(chain, ink::ocio::TRANSFORM_DIR_FORWARD);
        out.to_srgb = ink::matrix_of(chain, ink::ocio::TRANSFORM_DIR_INVERSE);
        return nullptr;
    } catch (const std::exception& fault) {
        static thread_local std::string words;
        words = fault.what();
        return words.c_str();
    }
}
