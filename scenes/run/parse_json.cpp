// SPDX-License-Identifier: MIT
#include "run/parse_json.hpp"

#include "run/byte_order_mark.hpp"
#include "run/input_error.hpp"

#include <set>
#include <vector>

namespace apsl::scenes {
namespace {

using Json = nlohmann::ordered_json;
using Event = Json::parse_event_t;

/// Looks at a text's objects and arrays as they open and close. The library itself keeps the last of two equal keys.
class Structure {
public:
    explicit Structure(const std::string& name) : name_(name) {}

    void meet(Event event, const Json& parsed) {
        if (event == Event::object_start || event == Event::array_start) {
            if (open_.size() == max_scene_depth)
                throw InputError(name_ + ": nested more than " + std::to_string(max_scene_depth) +
                                 " deep, expected a scene");
            open_.push_back({.is_array = event == Event::array_start, .keys = {}, .key = {}, .index = 0});
            return;
        }
        if (event == Event::key) {
            open_.back().key = parsed.get<std::string>();
            if (!open_.back().keys.insert(open_.back().key).second)
                throw InputError(name_ + ": " + path() + ": the same key comes twice, expected it once");
            return;
        }
        if (event != Event::value) open_.pop_back();
        if (!open_.empty()) ++open_.back().index;
    }

private:
    struct Open {
        bool is_array;
        std::set<std::string> keys;
        std::string key;
        std::size_t index;
    };

    std::string path() const {
        std::string text;
        for (const Open& open : open_)
            if (open.is_array)
                text.append("[").append(std::to_string(open.index)).append("]");
            else
                text.append(text.empty() ? "" : ".").append(open.key);
        return text;
    }

    const std::string& name_;
    std::vector<Open> open_;
};

}  // namespace

Json parse_json(std::string_view text, const std::string& name) {
    text = without_byte_order_mark(text, name);
    Structure structure(name);
    const auto look = [&](int, Event event, Json& parsed) {
        structure.meet(event, parsed);
        return true;
    };
    try {
        return Json::parse(text, look);
    } catch (const Json::exception& error) {
        std::string reason = error.what();  // "[json.exception.parse_error.101] parse error at line 3, column 5: ..."
        if (const std::size_t end = reason.find("] "); end != std::string::npos) reason.erase(0, end + 2);
        for (char& letter : reason)
            if (letter == '\n' || letter == '\r') letter = ' ';
        throw InputError(name + ": not valid JSON: " + reason);
    }
}

}  // namespace apsl::scenes
