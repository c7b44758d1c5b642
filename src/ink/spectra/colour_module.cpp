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

/// The product of the matrices of a chain without loss; curves at its ends are those of stored values.
Matrix3 matrix_of(const ocio::GroupTransformRcPtr& chain, ocio::TransformDirection direction) {
    const ocio::ConstProcessorRcPtr processor = ocio::Config::CreateRaw()->getProcessor(chain, direction);
    const ocio::GroupTransformRcPtr parts =
        processor->getOptimizedProcessor(ocio::OPTIMIZATION_LOSSLESS)->createGroupTransform();
    Matrix3 product{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    int n_matrices = 0;
    for (int part = 0; part < parts->getNumTransforms(); ++part) {
        const auto matrix = ocio::DynamicPtrCast<ocio::MatrixTransform>(parts->getTransform(part));
        if (!matrix) continue;
        std::array<double, 16> rows{};
        matrix->getMatrix(rows.data());
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j) product[i][j] = rows[4 * i + j];
        ++n_matrices;
    }
    if (n_matrices > 1) throw ocio::Exception("a chain of colour spaces has more than one matrix");
    return product;
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
