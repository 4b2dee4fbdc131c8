#include "tests/support/plotfile_writer.h"

#include <algorithm>
#include <bit>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <limits>
#include <random>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace weir::test {
namespace {

namespace fs = std::filesystem;

std::string text_of(const Index3& i) {
  std::ostringstream text;
  text << '(' << i.x << ',' << i.y << ',' << i.z << ')';
  return text.str();
}

std::string text_of(const Box& box) {
  return '(' + text_of(box.lo) + ' ' + text_of(box.hi - Index3{1, 1, 1}) + ' ' + text_of(Index3{}) + ')';
}

std::string layout_of(const PlotfilePlan& plan) {
  const std::string order = plan.single ? (plan.big_endian ? "(4, (1 2 3 4))" : "(4, (4 3 2 1))")
                                        : (plan.big_endian ? "(8, (1 2 3 4 5 6 7 8))" : "(8, (8 7 6 5 4 3 2 1))");
  return (plan.single ? "((8, (32 8 23 0 1 9 0 127))," : "((8, (64 11 52 0 1 12 0 1023)),") + order + ')';
}

template <typename T>
void append_value(std::string& bytes, T value, bool big_endian) {
  std::array<char, sizeof(T)> raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (big_endian != (std::endian::native == std::endian::big)) std::reverse(raw.begin(), raw.end());
  bytes.append(raw.data(), raw.size());
}

void write(const std::string& path, const std::string& content) {
  std::ofstream file(path, std::ios::binary);
  file << content;
  if (!file.flush()) throw std::runtime_error(path + " cannot be written");
}

/// Returns the text that says where a box lies. yt reads it.
std::string place_of(const PlotfilePlan& plan, std::size_t level, const Box& box) {
  std::ostringstream text;
  text.precision(17);
  const Index3 r = plan.ratio(0, level);
  const Index3 first = plan.domain_of(level).lo;
  const auto axis = [&](std::size_t a, std::int64_t lo, std::int64_t hi, std::int64_t ratio) {
    const double cell = plan.spacing.at(a) / static_cast<double>(ratio);
    text << plan.corner.at(a) + cell * static_cast<double>(lo) << ' '
         << plan.corner.at(a) + cell * static_cast<double>(hi) << '\n';
  };
  axis(0, box.lo.x - first.x, box.hi.x - first.x, r.x);
  axis(1, box.lo.y - first.y, box.hi.y - first.y, r.y);
  axis(2, box.lo.z - first.z, box.hi.z - first.z, r.z);
  return text.str();
}

std::string header_of(const PlotfilePlan& plan) {
  std::ostringstream text;
  text.precision(17);
  text << plan.type << '\n' << plan.components.size() << '\n';
  for (const std::string& name : plan.components) text << name << '\n';
  text << "3\n" << plan.time << '\n' << plan.levels() - 1 << '\n';
  const Index3 e = plan.domain.extent();
  const std::array<std::int64_t, 3> cells{e.x, e.y, e.z};
  for (const double c : plan.corner) text << c << ' ';
  text << '\n';
  for (std::size_t a = 0; a < 3; ++a) {
    text << plan.corner.at(a) + plan.spacing.at(a) * static_cast<double>(cells.at(a)) << ' ';
  }
  text << '\n';
  for (const Index3& ratio : plan.ratios) text << ratio.x << ' ';
  text << '\n';
  for (std::size_t l = 0; l < plan.levels(); ++l) text << text_of(plan.domain_of(l)) << ' ';
  text << '\n';
  for (std::size_t l = 0; l < plan.levels(); ++l) text << 10 << ' ';
  text << '\n';
  for (std::size_t l = 0; l < plan.levels(); ++l) {
    const Index3 r = plan.ratio(0, l);
    text << plan.spacing[0] / static_cast<double>(r.x) << ' ' << plan.spacing[1] / static_cast<double>(r.y) << ' '
         << plan.spacing[2] / static_cast<double>(r.z) << " \n";
  }
  text << "0\n0\n";
  for (std::size_t l = 0; l < plan.levels(); ++l) {
    text << l << ' ' << plan.boxes[l].size() << ' ' << plan.time << "\n10\n";
    for (const Box& box : plan.boxes[l]) text << place_of(plan, l, box);
    text << "Level_" << l << "/Cell\n";
  }
  return text.str();
}

struct Range {
  double min = std::numeric_limits<double>::infinity();
  double max = -std::numeric_limits<double>::infinity();
};

class LevelWriter {
 public:
  LevelWriter(const std::string& path, const PlotfilePlan& plan, std::size_t level)
      : plan_(plan), level_(level), directory_(path + "/Level_" + std::to_string(level)) {
    fs::create_directories(directory_);
  }

  void write_all() {
    const std::vector<Box>& boxes = plan_.boxes[level_];
    std::string bytes;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      std::ostringstream name;
      name << "Cell_D_" << std::setw(5) << std::setfill('0') << i / plan_.fabs_per_file;
      places_ << "FabOnDisk: " << name.str() << ' ' << bytes.size() << '\n';
      append_fab(boxes[i], bytes);
      if ((i + 1) % plan_.fabs_per_file != 0 && i + 1 != boxes.size()) continue;
      write(directory_ + '/' + name.str(), bytes);
      bytes.clear();
    }
    write(directory_ + "/Cell_H", cell_header());
  }

 private:
  void append_fab(const Box& box, std::string& bytes) {
    if (plan_.version == 1) {
      bytes += "FAB " + layout_of(plan_) + text_of(box) + ' ' + std::to_string(plan_.components.size()) + '\n';
    }
    std::vector<Range>& ranges = ranges_.emplace_back(plan_.components.size());
    for (std::size_t c = 0; c < plan_.components.size(); ++c) {
      for_each_index(box, [&](const Index3& cell) {
        const double value = plan_.value(level_, c, cell);
        ranges[c].min = std::min(ranges[c].min, value);
        ranges[c].max = std::max(ranges[c].max, value);
        if (plan_.single) {
          append_value(bytes, static_cast<float>(value), plan_.big_endian);
        } else {
          append_value(bytes, value, plan_.big_endian);
        }
      });
    }
  }

  void write_ranges(std::ostream& text, double Range::*end) const {
    text << ranges_.size() << ',' << plan_.components.size() << '\n';
    for (const std::vector<Range>& row : ranges_) {
      for (const Range& range : row) text << range.*end << ',';
      text << '\n';
    }
    text << '\n';
  }

  std::string cell_header() const {
    std::ostringstream text;
    text << std::scientific << std::setprecision(plan_.range_digits);
    const std::vector<Box>& boxes = plan_.boxes[level_];
    text << plan_.version << "\n1\n" << plan_.components.size() << "\n0\n(" << boxes.size() << " 0\n";
    for (const Box& box : boxes) text << text_of(box) << '\n';
    text << ")\n" << boxes.size() << '\n' << places_.str() << '\n';
    if (plan_.version == 1 || plan_.version == 3) {
      write_ranges(text, &Range::min);
      write_ranges(text, &Range::max);
    }
    if (plan_.version == 4) {
      for (double Range::*end : {&Range::min, &Range::max}) {
        for (std::size_t c = 0; c < plan_.components.size(); ++c) {
          double of_all = ranges_.front()[c].*end;
          for (const auto& row : ranges_) {
            of_all = end == &Range::min ? std::min(of_all, row[c].min) : std::max(of_all, row[c].max);
          }
          text << of_all << ',';
        }
        text << '\n';
      }
    }
    if (plan_.version != 1) text << layout_of(plan_) << '\n';
    return text.str();
  }

  const PlotfilePlan& plan_;
  std::size_t level_;
  std::string directory_;
  std::ostringstream places_;
  std::vector<std::vector<Range>> ranges_;
};

bool has_cell(const std::vector<Box>& boxes, const Index3& cell) {
  return std::any_of(boxes.begin(), boxes.end(), [&](const Box& box) { return box.contains(cell); });
}

}  // namespace

double plain_plotfile_value(std::size_t level, std::size_t component, const Index3& cell) {
  const std::int64_t place = (cell.x + 37 * cell.y + 1009 * cell.z) % 65536;
  return static_cast<double>(place + 65536 * static_cast<std::int64_t>(16 * level + component));
}

Box PlotfilePlan::domain_of(std::size_t level) const {
  const Index3 r = ratio(0, level);
  return {{domain.lo.x * r.x, domain.lo.y * r.y, domain.lo.z * r.z},
          {domain.hi.x * r.x, domain.hi.y * r.y, domain.hi.z * r.z}};
}

Index3 PlotfilePlan::ratio(std::size_t coarse, std::size_t fine) const {
  Index3 by{1, 1, 1};
  for (std::size_t l = coarse; l < fine; ++l) by = {by.x * ratios[l].x, by.y * ratios[l].y, by.z * ratios[l].z};
  return by;
}

void write_plotfile(const std::string& path, const PlotfilePlan& plan) {
  fs::create_directories(path);
  write(path + "/Header", header_of(plan));
  for (std::size_t l = 0; l < plan.levels(); ++l) LevelWriter(path, plan, l).write_all();
}

double composite_value(const PlotfilePlan& plan, std::size_t component, std::size_t level, const Index3& cell) {
  for (std::size_t l = level;; --l) {
    const Index3 r = plan.ratio(l, level);
    const Index3 coarse{floor_div(cell.x, r.x), floor_div(cell.y, r.y), floor_div(cell.z, r.z)};
    if (has_cell(plan.boxes[l], coarse)) return plan.value(l, component, coarse);
    if (l == 0) throw std::logic_error("no level has the cell " + text_of(cell));
  }
}

std::vector<Box> random_boxes(const Box& domain, std::int64_t longest, int kept, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Box> waiting{domain};
  std::vector<Box> boxes;
  while (!waiting.empty()) {
    const Box box = waiting.back();
    waiting.pop_back();
    const Index3 e = box.extent();
    const bool small = std::max({e.x, e.y, e.z}) <= longest;
    if (small && (random() % 4 != 0 || volume(e) == 1)) {
      if (std::cmp_less(random() % 100, kept)) boxes.push_back(box);
      continue;
    }
    const std::size_t axis = e.x >= e.y && e.x >= e.z ? 0 : e.y >= e.z ? 1 : 2;
    Box first = box;
    Box second = box;
    const auto cut = [&](std::int64_t Index3::*along) {
      const std::int64_t at =
          box.lo.*along + 1 + static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(e.*along - 1));
      first.hi.*along = at;
      second.lo.*along = at;
    };
    cut(axis == 0 ? &Index3::x : axis == 1 ? &Index3::y : &Index3::z);
    waiting.push_back(first);
    waiting.push_back(second);
  }
  std::shuffle(boxes.begin(), boxes.end(), random);
  return boxes;
}

PlotfilePlan generated_plotfile(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto between = [&](std::int64_t lo, std::int64_t hi) {
    return lo + static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(hi - lo + 1));
  };
  PlotfilePlan plan;
  plan.components = {"density", "x_velocity", "Temp"};
  const Index3 lo{between(-9, 9), between(-9, 9), between(-9, 9)};
  plan.domain = {lo, lo + Index3{between(3, 9), between(3, 9), between(3, 9)}};
  plan.boxes = {random_boxes(plan.domain, between(3, 9), 100, seed)};
  const std::vector<Index3> ratios{{2, 2, 2}, {4, 4, 4}, {2, 2, 1}, {1, 4, 2}, {3, 2, 2}};
  const std::size_t levels = 1 + seed % 4;
  for (std::size_t l = 1; l < levels && volume(plan.domain_of(l - 1).extent()) < 4'000; ++l) {
    plan.ratios.push_back(ratios[random() % ratios.size()]);
    std::vector<Box> boxes;
    const int kept = static_cast<int>(between(10, 90));
    plan.boxes.emplace_back();
    boxes = random_boxes(plan.domain_of(l), between(4, 20), kept, seed + 1000 * l);
    if (boxes.empty()) boxes = {{plan.domain_of(l).lo, plan.domain_of(l).lo + Index3{1, 1, 1}}};
    plan.boxes.back() = std::move(boxes);
  }
  plan.single = random() % 2 == 0;
  plan.big_endian = random() % 2 == 0;
  plan.fabs_per_file = static_cast<std::size_t>(between(1, 7));
  plan.version = static_cast<int>(between(1, 4));
  return plan;
}

}  // namespace weir::test
