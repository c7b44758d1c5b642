#pragma once

#include <string>

#include "brush/preset/preset.h"
#include "contact/contact.h"
#include "footprint/stamp/stamp.h"

/// \file
/// How a stroke becomes texels. Stored with every stroke in the journal, so that a replay gives the same bits.
namespace tuft::stroke {

/// What a brush holds as a stroke begins.
enum class DipMode {
    each,        ///< a fresh full brush for every stroke
    persistent,  ///< the hair and ink that the last entry with the brush left
};

/// Pressure of flat strokes whose device measured none (gesture/hand_pressure.h).
enum class PressureFrom { none, speed, dwell, speed_dwell };

/// What ink does on the surface.
enum class FilmModel {
    still,  ///< ink stays where it is deposited
    wet,    ///< ink flows, soaks in, dries, and is exchanged both ways between tuft and surface
};

/// Settings of one stroke. The journal stores them with it.
struct StrokeSettings {
    brush::SpineMethod spine = brush::SpineMethod::rod;      ///< `rod`: the method of the brush's preset
    footprint::Mapping footprint = footprint::Mapping::log;  ///< along the surface, or on one plane
    contact::Method contact = contact::Method::exact;
    double spacing = 1.0;            ///< between two stamps, in (0, 1000); see pose_spacing
    bool compensate_tip_lag = true;  ///< flat: the hand leads the ink, which so lies on the samples
    DipMode dip = DipMode::each;
    bool endless = false;                        ///< the tuft holds before every pose what it held at pen down
    PressureFrom pressure = PressureFrom::none;  ///< of flat samples; none: as sampled
    double smooth = 0;                           ///< strength of the filter (`hand_filter_options`), 0–100; 0: off
    FilmModel film = FilmModel::still;
    Vec3 down{0, 0, -1};       ///< direction of gravity, for wet ink, length < 1e9; zero: no weight
    double stabilise = 0;      ///< metres, 0–1: length of the string that pulls the tip; 0: off
    double roll = 0;           ///< radians, within ±`kMostRoll`, added to that of flat samples (see StrokeSample)
    bool roll_follow = false;  ///< flat: the ferrule's broad side turns across the path, see roll.h

    bool operator==(const StrokeSettings&) const = default;
};

/// Words of files and of the command line, and back. The functions back throw `Error` for any other word.
std::string name_of(DipMode dip);              ///< each, persistent
std::string name_of(PressureFrom from);        ///< none, speed, dwell, speed+dwell
std::string name_of(FilmModel film);           ///< still, wet
DipMode dip_mode_of(const std::string& name);  ///< takes "carry" too, the earlier word for persistent
PressureFrom pressure_from(const std::string& name);
FilmModel film_model_of(const std::string& name);
brush::SpineMethod spine_method_of(const std::string& name);       ///< brush::kSpineWords
footprint::Mapping footprint_mapping_of(const std::string& name);  ///< surface, plane
contact::Method contact_method_of(const std::string& name);        ///< exact, vertices

/// Settings as one line of JSON, and back. Unknown keys are ignored; wrong types and values throw `Error`.
std::string to_json(const StrokeSettings& settings);
StrokeSettings settings_from_json(const std::string& json);
/// Throws `Error` for a number out of range.
void check_settings(const StrokeSettings& settings);

}  // namespace tuft::stroke
