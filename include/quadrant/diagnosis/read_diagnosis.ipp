// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "effect/effect_list.hpp"
#include "result/result.hpp"
#include "text/json_keys.hpp"

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// One reading of a diagnosis file: docs/formats.md's keys must be there, those that this project adds may.
/// Keys that are not
/// known are left alone: a later version may say more.
class diagnosis_reader {
public:
    diagnosis_reader(std::string_view text, std::string_view file)
        : root_(parse_json(text, file)), top_{&root_, "", file} {}

    diagnosis_result read() {
        need_schema(top_, "quadrant.diagnosis/1");
        diagnosis_result out;
        out.verdict = verdict_of(top_.need("verdict"));
        if (const auto own = top_.find("own_effects")) own_ = out.own_effects = words(*own);
        const json_node axes = top_.need("axes").object();
        for (const auto& [name, axis] : axes.value->items())
            out.axes.push_back(read_axis(name, axes.at(name, axis)));
        each(top_.need("causes"), [&](const json_node& n) { out.causes.push_back(read_cause(n, out)); });
        const json_node remaining = top_.need("remaining").object();
        out.share_unexplained = finite(remaining.need("share_of_gap_unexplained"));
        out.remaining_structure = remaining.need("structure").text();
        const json_node next = top_.need("next_experiment").object();
        out.next = {next.need("motion").text(), words(next.need("separates")),
                    finite(next.need("expected_gain"))};
        if (const auto gain = next.find("gain_of_log")) out.next.gain_of_log = finite(*gain);
        if (const auto finding = next.find("finding")) out.next.finding = finding->text();
        if (const auto axis = next.find("axis")) out.next.axis = axis->text();
        if (const auto notes = top_.find("notes")) out.notes = words(*notes);
        if (const auto unseen = top_.find("not_seen"))
            each(*unseen, [&](const json_node& n) {
                out.not_seen.push_back(
                    {n.object().need("axis").text(), n.need("what").text(), n.need("instrument").text()});
            });
        if (const auto files = top_.find("files")) {
            files->object();
            read_file(*files, "machine", out.machine_file, out.machine_sha256);
            read_file(*files, "log", out.log_file, out.log_sha256);
            read_file(*files, "holdout", out.holdout_file, out.holdout_sha256);
        }
        return out;
    }

private:
    static void read_file(const json_node& files, const char* role, std::string& name, std::string& sha256) {
        const auto file = files.find(role);
        if (!file) return;
        name = file->object().need("name").text();
        sha256 = file->need("sha256").text();
    }
    static double finite(const json_node& node) {
        if (!node.value->is_number() || !std::isfinite(node.value->get<double>()))
            node.refuse("must be a number");
        return node.value->get<double>();
    }
    static double share(const json_node& node) {
        const double x = finite(node);
        if (x < 0 || x > 1) node.refuse("must be a number from 0 to 1");
        return x;
    }
    template <class Use> static void each(const json_node& node, Use use) {
        if (!node.value->is_array()) node.refuse("must be an array");
        std::size_t i = 0;
        for (const auto& entry : *node.value)
            use(json_node{&entry, fmt::format("{}[{}]", node.path, i++), node.file});
    }
    static std::vector<std::string> words(const json_node& node) {
        std::vector<std::string> out;
        each(node, [&](const json_node& n) { out.push_back(n.text()); });
        return out;
    }
    static verdict verdict_of(const json_node& node) {
        for (const verdict v : {verdict::no_gap, verdict::within_tolerance, verdict::explained,
                                verdict::partly_explained, verdict::unexplained})
            if (node.text() == name_of(v)) return v;
        node.refuse("must be explained, partly_explained, unexplained, within_tolerance or no_gap");
    }
    std::string effect_of(const json_node& node) const {
        const auto known = names_of_effects();
        const std::string& name = node.text();
        if (std::find(known.begin(), known.end(), name) == known.end() &&
            std::find(own_.begin(), own_.end(), name) == own_.end())
            node.refuse(fmt::format("{} is not an effect{}", in_quotes(name), suggestion(name, known)));
        return name;
    }

    static estimate interval(const json_node& value, const json_node& ci95) {
        estimate out{finite(value), 0, 0};
        std::vector<double> ends;
        each(ci95, [&](const json_node& n) { ends.push_back(finite(n)); });
        if (ends.size() != 2) ci95.refuse("must be the two ends of an interval");
        out.low = ends[0];
        out.high = ends[1];
        return out;
    }
    static estimate alone(const json_node& node) {
        const double x = finite(node);
        return {x, x, x};
    }
    static std::vector<parameter_estimate> parameters(const json_node& node) {
        std::vector<parameter_estimate> out;
        for (const auto& [key, entry] : node.object().value->items()) {
            const json_node one = node.at(key, entry).object(), value = one.need("value"),
                            ci95 = one.need("ci95");
            parameter_estimate p{.key = key, .values = {}};
            if (const auto bound = one.find("on_bound"))
                p.on_bound = bound->value->is_boolean() && bound->value->get<bool>();
            if (!value.value->is_array()) {
                p.values.push_back(interval(value, ci95));
            } else {
                std::vector<json_node> values, intervals;
                each(value, [&](const json_node& n) { values.push_back(n); });
                each(ci95, [&](const json_node& n) { intervals.push_back(n); });
                if (values.size() != intervals.size()) ci95.refuse("must have one interval for each value");
                for (std::size_t i = 0; i < values.size(); ++i)
                    p.values.push_back(interval(values[i], intervals[i]));
            }
            out.push_back(std::move(p));
        }
        return out;
    }

    static gap_numbers gap(const json_node& node) {
        gap_numbers g;
        g.position_rms_m = finite(node.object().need("position_rms_m"));
        g.position_peak_m = finite(node.need("position_peak_m"));
        g.command_rms_V = finite(node.need("command_rms_V"));
        g.force_rms_N = finite(node.need("force_rms_N"));
        g.noise_floor_force_rms_N = finite(node.need("noise_floor_force_rms_N"));
        g.bandwidth_Hz = finite(node.need("bandwidth_Hz"));
        return g;
    }
    static place read_place(const json_node& node) {
        place p;
        p.view = node.object().need("view").text();
        if (const auto block = node.find("block")) p.block = block->text();
        p.finding = node.need("finding").text();
        const json_node value = node.need("share");
        const auto ends = node.find("share_ci95");
        p.share = ends ? interval(value, *ends) : alone(value);
        if (const auto basis = node.find("basis")) p.basis = basis->text();
        return p;
    }
    static axis_result read_axis(const std::string& name, json_node node) {
        axis_result a;
        a.name = name;
        if (const auto kind = node.object().find("kind")) {
            if (kind->text() != "linear" && kind->text() != "rotary") kind->refuse("must be linear or rotary");
            a.kind = node.kind = kind->text() == "rotary" ? axis_kind::rotary : axis_kind::linear;
        }
        if (const auto unit = node.find("command_unit")) a.command_unit = unit->text();
        a.verdict = verdict_of(node.object().need("verdict"));
        a.gap = gap(node.need("gap"));
        const auto after = node.find("gap_after");
        a.gap_after = after ? gap(*after) : a.gap;
        each(node.need("where"), [&](const json_node& n) { a.where.push_back(read_place(n)); });
        if (const auto values = node.find("calibrated")) a.calibrated = parameters(*values);
        if (const auto values = node.find("calibrated_with_suspects"))
            a.calibrated_with_suspects = parameters(*values);
        if (const auto on = node.find("evaluated_on")) a.evaluated_on = on->text();
        return a;
    }
    cause read_cause(json_node node, const diagnosis_result& whole) const {
        cause c;
        const json_node axis = node.object().need("axis");
        c.axis = axis.text();
        if (std::none_of(whole.axes.begin(), whole.axes.end(), [&](const auto& a) { return a.name == c.axis; }))
            axis.refuse(fmt::format("{} is not one of the diagnosis' axes", in_quotes(c.axis)));
        node.kind = whole.kind_of(c.axis);
        c.effect = effect_of(node.need("effect"));
        if (const auto described = node.find("described")) {
            if (!described->value->is_boolean()) described->refuse("must be true or false");
            c.described = described->value->get<bool>();
        }
        c.probability = share(node.need("probability"));
        c.group_probability = share(node.need("group_probability"));
        c.confusable_with = words(node.need("confusable_with"));
        c.parameters = parameters(node.need("parameters"));
        if (const auto values = node.find("with_suspects")) c.with_suspects = parameters(*values);
        if (const auto readings = node.find("readings"))
            each(*readings, [&](const json_node& n) {
                c.readings.push_back({effect_of(n.object().need("effect")), parameters(n.need("parameters"))});
            });
        c.gap_before_force_rms_N = alone(node.need("gap_before_force_rms_N"));
        c.gap_after_force_rms_N = alone(node.need("gap_after_force_rms_N"));
        c.gap_before_position_rms_m = alone(node.need("gap_before_position_rms_m"));
        c.gap_after_position_rms_m = alone(node.need("gap_after_position_rms_m"));
        if (const auto given = node.find("gap_before_command_rms_V"))
            c.gap_before_command_rms_V = alone(*given);
        if (const auto given = node.find("gap_after_command_rms_V")) c.gap_after_command_rms_V = alone(*given);
        c.shrink = interval(node.need("shrink"), node.need("shrink_ci95"));
        if (const auto motion = node.find("exciting_motion")) c.exciting_motion = motion->text();
        return c;
    }

    nlohmann::json root_;
    json_node top_;
    std::vector<std::string> own_;
};

} // namespace detail

QUADRANT_DIAGNOSIS_DECL diagnosis_result read_diagnosis(std::string_view text, std::string_view name) {
    return detail::diagnosis_reader(text, name).read();
}
QUADRANT_DIAGNOSIS_DECL diagnosis_result read_diagnosis(const std::filesystem::path& path) {
    return read_diagnosis(detail::read_whole(path), path.string());
}

} // namespace quadrant::inline v0::diagnosis
