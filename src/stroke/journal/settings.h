#pragma once

#include <string>

#include "brush/preset/preset.h"
#include "contact/contact.h"
#include "footprint/stamp/stamp.h"

/// \file
/// How strokes become texels. Part of the journal, so that a replay is the same.
namespace tuft::stroke {

enum class DipMode {
    each,   ///< every stroke with a fresh full brush
    carry,  ///< with the hair and ink that the last one with it left
};

/// Pressure of flat strokes whose device gave none, see hand_pressure.h.
enum class PressureFrom { none, speed, dwell, speed_dwell };

enum class FilmModel {
    still,  ///< ink stays where it is put
    wet,    ///< it flows, soaks in and dries, and goes both ways between brush and surface
};

struct StrokeSettings {
    brush::SpineMethod spine = brush::SpineMethod::rod;      ///< `rod`: as the brush's preset says
    footprint::Mapping footprint = footprint::Mapping::log;  ///< along the surface, or on one plane
    contact::Method contact = contact::Method::exact;
    double spacing = 1.0;            ///< texels between two stamps, 0–1000
    bool compensate_tip_lag = true;  ///< flat: the hand runs ahead so that the ink lies on
                                     ///< the samples
    DipMode dip = DipMode::each;
    bool endless = false;                        ///< the ink that leaves the tuft is replaced at once,
                                                 ///< what it takes up is gone: it paints as full as it
                                                 ///< began
    PressureFrom pressure = PressureFrom::none;  ///< of flat samples; none: as sampled
    double smooth = 0;                           ///< strength of the hand's filter; 0: off, 1: its
                                                 ///< defaults
    FilmModel film = FilmModel::still;
    Vec3 down{0, 0, -1};       ///< towards the ground, for wet ink; zero: no weight
    double stabilise = 0;      ///< metres of the string that pulls the tip; 0: off
    double roll = 0;           ///< radians, added to that of flat samples (see StrokeSample)
    bool roll_follow = false;  ///< of flat samples: the ferrule's broad side turns across the path, see roll.h

    bool operator==(const StrokeSettings&) const = default;
};

/// The words that files and the command line have for them; back throws `Error` for another word.
std::string name_of(DipMode dip);        ///< each, carry
std::string name_of(PressureFrom from);  ///< none, speed, dwell, speed+dwell
std::string name_of(FilmModel film);     ///< still, wet
DipMode dip_mode_of(const std::string& name);
PressureFrom pressure_from(const std::string& name);
FilmModel film_model_of(const std::string& name);
brush::SpineMethod spine_method_of(const std::string& name);       ///< rod, table
footprint::Mapping footprint_mapping_of(const std::string& name);  ///< surface, plane
contact::Method contact_method_of(const std::string& name);        ///< exact, vertices

/// Settings as one line of JSON, and back; unknown keys are ignored, wrong types and values throw `Error`.
std::string to_json(const StrokeSettings& settings);
StrokeSettings settings_from_json(const std::string& json);
/// Throws `Error` for a number out of range.
void check_settings(const StrokeSettings& settings);

}  // namespace tuft::stroke
