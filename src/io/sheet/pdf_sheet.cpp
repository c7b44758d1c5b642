#include <fmt/format.h>
#include <podofo/podofo.h>

#include <array>

#include "core/error.h"
#include "core/system/build_facts.h"
#include "io/image/icc_profile.h"
#include "io/sheet/sheet_files.h"

/// PDF by PoDoFo: objects, cross-references and compression are its own; the content of pages is written here, because
/// its painter knows neither overprint nor images in separations.
namespace tuft::io {
namespace {

using PoDoFo::PdfArray;
using PoDoFo::PdfDictionary;
using PoDoFo::PdfName;
using PoDoFo::PdfObject;
using PoDoFo::PdfVariant;

constexpr double kPointsPerMetre = 72 / 0.0254;
constexpr double kHairline = 0.25;  // points
constexpr double kLabelLine = 0.5;

PdfVariant number(double value) {
    return PdfVariant(value);
}

PdfArray numbers(std::initializer_list<double> values) {
    PdfArray array;
    for (const double v : values) array.push_back(number(v));
    return array;
}

/// One document while it is made.
class PdfSheet {
  public:
    explicit PdfSheet(const decal::Sheet& sheet) : sheet_(sheet) {}

    std::string bytes() {
        document_.SetPdfVersion(PoDoFo::ePdfVersion_1_6);
        // The file's identifier is made of this date, too: without it the same sheet is the same file.
        document_.GetInfo()->GetObject()->GetDictionary().RemoveKey("CreationDate");
        make_spaces();
        for (const decal::Page& page : sheet_.pages) add_page(page);
        PoDoFo::PdfRefCountedBuffer buffer;
        PoDoFo::PdfOutputDevice device(&buffer);
        document_.Write(&device);
        return std::string(buffer.GetBuffer(), device.GetLength());
    }

  private:
    PdfObject* separation(const std::string& name, const char* alternate, const PdfArray& none, const PdfArray& full) {
        PdfDictionary function;
        function.AddKey("FunctionType", PdfVariant(static_cast<PoDoFo::pdf_int64>(2)));
        function.AddKey("Domain", numbers({0, 1}));
        function.AddKey("C0", none);
        function.AddKey("C1", full);
        function.AddKey("N", PdfVariant(static_cast<PoDoFo::pdf_int64>(1)));
        PdfArray space;
        space.push_back(PdfName("Separation"));
        space.push_back(PdfName(name));
        space.push_back(PdfName(alternate));
        space.push_back(document_.GetObjects().CreateObject(PdfVariant(function))->Reference());
        return document_.GetObjects().CreateObject(PdfVariant(space));
    }

    PdfObject* profiled_rgb() {
        const std::vector<std::uint8_t> profile =
            sheet_.profile.empty() ? icc_profile(ink::ColourSpace::srgb) : sheet_.profile;
        PdfObject* stream = document_.GetObjects().CreateObject();
        stream->GetDictionary().AddKey("N", PdfVariant(static_cast<PoDoFo::pdf_int64>(3)));
        stream->GetDictionary().AddKey("Alternate", PdfName("DeviceRGB"));
        stream->GetStream()->Set(reinterpret_cast<const char*>(profile.data()),
                                 static_cast<PoDoFo::pdf_long>(profile.size()), {PoDoFo::ePdfFilter_FlateDecode});
        PdfArray space;
        space.push_back(PdfName("ICCBased"));
        space.push_back(stream->Reference());
        return document_.GetObjects().CreateObject(PdfVariant(space));
    }

    void make_spaces() {
        rgb_ = profiled_rgb();
        cut_ = separation(kCutContour, "DeviceCMYK", numbers({0, 0, 0, 0}), numbers({0, 1, 0, 0}));
        all_ = separation("All", "DeviceCMYK", numbers({0, 0, 0, 0}), numbers({1, 1, 1, 1}));
        for (const decal::Plate& plate : sheet_.plates)
            plates_.push_back(separation(plate.name, "DeviceRGB", numbers({1, 1, 1}),
                                         numbers({plate.colour[0], plate.colour[1], plate.colour[2]})));
        PdfDictionary state;
        state.AddKey("Type", PdfName("ExtGState"));
        state.AddKey("OP", PdfVariant(true));
        state.AddKey("op", PdfVariant(true));
        state.AddKey("OPM", PdfVariant(static_cast<PoDoFo::pdf_int64>(1)));
        overprint_ = document_.GetObjects().CreateObject(PdfVariant(state));
        // Plates lie over each other as films do: where one has no ink, multiplying leaves the others alone. Not
        // together with overprint: then Ghostscript multiplies the plates that are already there by themselves.
        PdfDictionary over;
        over.AddKey("Type", PdfName("ExtGState"));
        over.AddKey("BM", PdfName("Multiply"));
        plate_state_ = document_.GetObjects().CreateObject(PdfVariant(over));
    }

    PdfObject* picture(const decal::PrintImage& image, const std::vector<std::uint8_t>& data, const PdfVariant& space) {
        PdfObject* object = document_.GetObjects().CreateObject("XObject");
        PdfDictionary& dictionary = object->GetDictionary();
        dictionary.AddKey("Subtype", PdfName("Image"));
        dictionary.AddKey("Width", PdfVariant(static_cast<PoDoFo::pdf_int64>(image.width)));
        dictionary.AddKey("Height", PdfVariant(static_cast<PoDoFo::pdf_int64>(image.height)));
        dictionary.AddKey("BitsPerComponent", PdfVariant(static_cast<PoDoFo::pdf_int64>(8)));
        dictionary.AddKey("ColorSpace", space);
        object->GetStream()->Set(reinterpret_cast<const char*>(data.data()), static_cast<PoDoFo::pdf_long>(data.size()),
                                 {PoDoFo::ePdfFilter_FlateDecode});
        return object;
    }

    void add_picture(const decal::PrintImage& image, PdfDictionary& resources, std::string& content) {
        const auto place = [&](const std::string& state, PdfObject* object) {
            const std::string name = fmt::format("Im{}", resources.GetKeys().size());
            resources.AddKey(PdfName(name), object->Reference());
            content +=
                fmt::format("q {}{:.4f} 0 0 {:.4f} {:.4f} {:.4f} cm /{} Do Q\n", state,
                            image.width * image.pixel * kPointsPerMetre, image.height * image.pixel * kPointsPerMetre,
                            image.origin.x * kPointsPerMetre, image.origin.y * kPointsPerMetre, name);
        };
        for (std::size_t i = 0; i < image.plates.size(); ++i) {
            PdfObject* plate = picture(image, image.plates[i], PdfVariant(plates_[i]->Reference()));
            // Without ink nothing is drawn: viewers that round each product down would show a grey box of eight plates.
            plate->GetDictionary().AddKey("Mask", numbers({0, 0}));
            place("/Plate gs ", plate);
        }
        if (!image.plates.empty()) return;
        PdfObject* colour = picture(image, image.rgb, PdfVariant(rgb_->Reference()));
        PdfObject* mask = picture(image, image.alpha, PdfVariant(PdfName("DeviceGray")));
        colour->GetDictionary().AddKey("SMask", mask->Reference());
        place("", colour);
    }

    void add_area(const decal::InkArea& area, std::string& content) const {
        const decal::SheetInk& ink = sheet_.inks[area.ink];
        content += sheet_.plates.empty() ? fmt::format("q /Colour cs {:.4f} {:.4f} {:.4f} scn\n", ink.colour[0],
                                                       ink.colour[1], ink.colour[2])
                                         : fmt::format("q /Plate gs /Plate{} cs 1 scn\n", area.ink);
        for (const decal::Ring& ring : area.region) {
            add_points(ring, content);
            content += "h\n";
        }
        content += "f Q\n";
    }

    static void add_points(const std::vector<Vec2>& points, std::string& content) {
        for (std::size_t i = 0; i < points.size(); ++i)
            content += fmt::format("{:.4f} {:.4f} {} ", points[i].x * kPointsPerMetre, points[i].y * kPointsPerMetre,
                                   i == 0 ? 'm' : 'l');
    }

    static void add_line(const decal::Line& line, std::string& content) {
        add_points(line.points, content);
        content += line.closed ? "s\n" : "S\n";
    }

    static void add_lines(const decal::Page& page, decal::Role role, const std::string& style, std::string& content) {
        content += "q " + style + "\n";
        for (const decal::Line& line : page.lines)
            if (line.role == role) add_line(line, content);
        content += "Q\n";
    }

    void add_page(const decal::Page& page) {
        const double width = page.size.x * kPointsPerMetre, height = page.size.y * kPointsPerMetre;
        PoDoFo::PdfPage* own = document_.CreatePage(PoDoFo::PdfRect(0, 0, width, height));
        // PdfRect rounds nothing, but writes what it was given; trim and bleed are the whole page.
        own->GetObject()->GetDictionary().AddKey("MediaBox", numbers({0, 0, width, height}));
        own->GetObject()->GetDictionary().AddKey("TrimBox", numbers({0, 0, width, height}));
        PdfDictionary spaces, states, pictures;
        spaces.AddKey("Cut", cut_->Reference());
        spaces.AddKey("Marks", all_->Reference());
        if (!page.areas.empty()) {
            spaces.AddKey("Colour", rgb_->Reference());
            for (std::size_t i = 0; i < plates_.size(); ++i)
                spaces.AddKey(PdfName(fmt::format("Plate{}", i)), plates_[i]->Reference());
        }
        states.AddKey("Overprint", overprint_->Reference());
        states.AddKey("Plate", plate_state_->Reference());
        std::string content;
        for (const decal::PrintImage& image : page.prints) add_picture(image, pictures, content);
        for (const decal::InkArea& area : page.areas) add_area(area, content);
        add_lines(page, decal::Role::label, fmt::format("/Marks CS 1 SCN {} w 1 J 1 j", kLabelLine), content);
        add_lines(page, decal::Role::mark, fmt::format("/Marks CS 1 SCN {} w", kHairline), content);
        add_lines(page, decal::Role::cut, fmt::format("/Overprint gs /Cut CS 1 SCN {} w", kHairline), content);
        PdfDictionary& resources = own->GetResources()->GetDictionary();
        resources.AddKey("ColorSpace", spaces);
        resources.AddKey("ExtGState", states);
        resources.AddKey("XObject", pictures);
        own->GetContentsForAppending()->GetStream()->Set(content.data(), static_cast<PoDoFo::pdf_long>(content.size()));
    }

    const decal::Sheet& sheet_;
    PoDoFo::PdfMemDocument document_;
    PdfObject* rgb_ = nullptr;  // of pictures
    PdfObject *cut_ = nullptr, *all_ = nullptr, *overprint_ = nullptr, *plate_state_ = nullptr;
    std::vector<PdfObject*> plates_;
};

}  // namespace

std::string pdf_bytes(const decal::Sheet& sheet) {
    PoDoFo::PdfError::EnableDebug(false);
    PoDoFo::PdfError::EnableLogging(false);
    try {
        return PdfSheet(sheet).bytes();
    } catch (const PoDoFo::PdfError& error) {
        const char* why = PoDoFo::PdfError::ErrorMessage(error.GetError());
        throw Error(Message("the PDF cannot be made: {}", std::string(why ? why : "")));
    }
}

}  // namespace tuft::io
