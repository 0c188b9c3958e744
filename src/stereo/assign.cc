#include <cmath>
#include <limits>
#include <stdexcept>

#include "stereomotion/stereo/match_balls.h"

namespace stereomotion {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Solves the assignment by shortest augmenting paths with potentials, one row after the other.
/// "No match" is one more column, index `cols()`, that any number of rows may share: it is always
/// free and never expanded, so its potential stays 0.
class Assignment {
 public:
  Assignment(const Eigen::MatrixXd& cost, double no_match_cost)
      : cost_(cost),
        no_match_cost_(no_match_cost),
        row_potential_(Eigen::VectorXd::Zero(cost.rows())),
        column_potential_(Eigen::VectorXd::Zero(cost.cols() + 1)),
        row_of_column_(static_cast<std::size_t>(cost.cols()), -1) {}

  std::vector<int> Solve() {
    for (int row = 0; row < cost_.rows(); ++row) Insert(row);
    std::vector<int> column_of_row(static_cast<std::size_t>(cost_.rows()), -1);
    for (int j = 0; j < cost_.cols(); ++j) {
      if (row_of_column_[j] >= 0) column_of_row[row_of_column_[j]] = j;
    }
    return column_of_row;
  }

 private:
  [[nodiscard]] double Reduced(int row, int column) const {
    const double cost = column == cost_.cols() ? no_match_cost_ : cost_(row, column);
    return cost - row_potential_[row] - column_potential_[column];
  }

  /// Grows a tree of tight edges from `row` until it reaches a free column, then flips the path.
  void Insert(int row) {
    const int num_columns = static_cast<int>(cost_.cols()) + 1;
    std::vector<double> slack(static_cast<std::size_t>(num_columns), kInfinity);
    std::vector<int> parent_column(static_cast<std::size_t>(num_columns), -1);
    std::vector<bool> in_tree(static_cast<std::size_t>(num_columns), false);
    int column = -1;  // the column whose row is being expanded; −1: the new row itself
    for (int current_row = row; current_row >= 0;) {
      int next = -1;
      for (int j = 0; j < num_columns; ++j) {
        if (in_tree[j]) continue;
        const double reduced = Reduced(current_row, j);
        if (reduced < slack[j]) {
          slack[j] = reduced;
          parent_column[j] = column;
        }
        if (next < 0 || slack[j] < slack[next]) next = j;
      }
      UpdatePotentials(row, slack[next], in_tree, slack);
      in_tree[next] = true;
      column = next;
      current_row = next == num_columns - 1 ? -1 : row_of_column_[next];
    }
    Flip(row, column, parent_column);
  }

  void UpdatePotentials(int row, double delta, const std::vector<bool>& in_tree,
                        std::vector<double>& slack) {
    row_potential_[row] += delta;
    for (std::size_t j = 0; j < in_tree.size(); ++j) {
      if (in_tree[j]) {
        row_potential_[row_of_column_[j]] += delta;
        column_potential_[static_cast<Eigen::Index>(j)] -= delta;
      } else {
        slack[j] -= delta;
      }
    }
  }

  void Flip(int row, int column, const std::vector<int>& parent_column) {
    while (column >= 0) {
      const int parent = parent_column[column];
      const int new_row = parent < 0 ? row : row_of_column_[parent];
      if (column < cost_.cols()) row_of_column_[column] = new_row;
      column = parent;
    }
  }

  const Eigen::MatrixXd& cost_;
  double no_match_cost_;
  Eigen::VectorXd row_potential_;
  Eigen::VectorXd column_potential_;
  std::vector<int> row_of_column_;
};

}  // namespace

std::vector<int> AssignOneToOne(const Eigen::MatrixXd& cost, double no_match_cost) {
  if (!std::isfinite(no_match_cost) || cost.hasNaN() || (cost.array() == -kInfinity).any()) {
    throw std::invalid_argument("AssignOneToOne: costs must be numbers, and finite for no match");
  }
  return Assignment(cost, no_match_cost).Solve();
}

}  // namespace stereomotion
