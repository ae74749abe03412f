// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "fleet.hpp"
#include "work_list.hpp"

namespace quadrant_gap::fleet {

/// The crew as the leader sees it: who has room, and with what program.
class desk {
public:
    desk(crew& others, const workshop& w)
        : others_(others), program_sha256_(w.program_sha256),
          room_(static_cast<std::size_t>(others.others()) + 1, 0) {}
    ~desk() {
        for (int who = 1; who <= others_.others(); ++who) others_.give(who, "");
    }
    desk(const desk&) = delete;
    desk& operator=(const desk&) = delete;

    bool all_have_come() const { return come_ == others_.others(); }
    void hand_out(work_list& list) {
        for (int who = 1; who <= others_.others(); ++who)
            for (; room_[index(who)] > 0 && !list.to_do().empty(); --room_[index(who)]) {
                const std::size_t k = list.next();
                const entry& e = list.at(k);
                others_.give(who, ordered_json{{"index", k},
                                               {"name", e.name},
                                               {"machine", e.machine.string()},
                                               {"log", e.log.string()},
                                               {"holdout", e.holdout.string()},
                                               {"fault", e.fault}}
                                      .dump());
            }
    }
    std::optional<outcome> hear() {
        while (const auto heard = others_.hear()) {
            const auto said = ordered_json::parse(heard->second);
            if (said.contains("index")) {
                ++room_[index(heard->first)];
                return outcome{said["index"], said["error"], said["seconds"]};
            }
            if (said["program_sha256"] != program_sha256_)
                throw bad_input(said["host"].get<std::string>(),
                                "its quadrant-gap is not the one of the first process: results would differ");
            room_[index(heard->first)] = said["jobs"];
            ++come_;
        }
        return std::nullopt;
    }

private:
    static std::size_t index(int who) { return static_cast<std::size_t>(who); }
    crew& others_;
    std::string program_sha256_;
    std::vector<std::size_t> room_;
    int come_ = 0;
};

} // namespace quadrant_gap::fleet
