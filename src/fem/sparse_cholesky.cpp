#include "fem/sparse_cholesky.h"

#include <cholmod.h>

#include <vector>

#include "base/error.h"
#include "fem/blas.h"

namespace trackbed::fem {

namespace {

/// Right-hand sides solved together; fixed, so that results do not depend on how many threads share them.
constexpr Eigen::Index chunk = 16;

struct Common {
  cholmod_common c;
  Common() {
    cholmod_l_start(&c);
    c.print = 0;
    c.supernodal = CHOLMOD_SUPERNODAL;
    c.quick_return_if_not_posdef = 1;
    c.nmethods = 1;
    c.method[0].ordering = CHOLMOD_GIVEN;
    c.postorder = 1;
    c.metis_memory = 0;
  }
  ~Common() { cholmod_l_finish(&c); }
  Common(const Common&) = delete;
};

using Index64 = std::vector<SuiteSparse_long>;

/// Order of the nodes that have free displacements, by nested dissection of their graph.
Index64 order_nodes(const SparseMatrix& m, const std::vector<int>& node_of, int nodes, cholmod_common* c) {
  Index64 starts{0}, rows;
  std::vector<int> seen(static_cast<std::size_t>(nodes), -1);
  int column = 0;
  for (int n = 0; n < nodes; ++n) {
    for (; column < m.cols() && node_of[static_cast<std::size_t>(column)] == n; ++column)
      for (SparseMatrix::InnerIterator it(m, column); it; ++it) {
        const int other = node_of[static_cast<std::size_t>(it.row())];
        if (seen[static_cast<std::size_t>(other)] == n) continue;
        seen[static_cast<std::size_t>(other)] = n;
        if (other < n) rows.push_back(other);  // the upper triangle
      }
    starts.push_back(static_cast<SuiteSparse_long>(rows.size()));
  }
  cholmod_sparse graph{};
  graph.nrow = graph.ncol = static_cast<std::size_t>(nodes);
  graph.nzmax = rows.size();
  graph.p = starts.data();
  graph.i = rows.data();
  graph.stype = 1;
  graph.itype = CHOLMOD_LONG;
  graph.xtype = CHOLMOD_PATTERN;
  graph.packed = 1;
  Index64 order(static_cast<std::size_t>(nodes));
  if (!cholmod_l_metis(&graph, nullptr, 0, 1, order.data(), c))
    throw RunError("the nodes of a finite element mesh cannot be ordered: not enough memory");
  return order;
}

/// The matrix' upper triangle as CHOLMOD takes it; the numbers stay where Eigen has them.
struct Upper {
  Index64 starts, rows;
  std::vector<double> values;
  cholmod_sparse view{};

  explicit Upper(const SparseMatrix& m) {
    starts.push_back(0);
    for (int column = 0; column < m.cols(); ++column) {
      for (SparseMatrix::InnerIterator it(m, column); it && it.row() <= column; ++it) {
        rows.push_back(it.row());
        values.push_back(it.value());
      }
      starts.push_back(static_cast<SuiteSparse_long>(rows.size()));
    }
    view.nrow = view.ncol = static_cast<std::size_t>(m.cols());
    view.nzmax = rows.size();
    view.p = starts.data();
    view.i = rows.data();
    view.x = values.data();
    view.stype = 1;
    view.itype = CHOLMOD_LONG;
    view.xtype = CHOLMOD_REAL;
    view.dtype = CHOLMOD_DOUBLE;
    view.sorted = view.packed = 1;
  }
};

}  // namespace

struct SparseCholesky::Parts {
  Common common;
  cholmod_factor* factor = nullptr;
  ~Parts() {
    if (factor) cholmod_l_free_factor(&factor, &common.c);
  }
  void factorize(Upper& m) {
    cholmod_common* c = &common.c;
    if (factor) cholmod_l_factorize(&m.view, factor, c);
    if (!factor || c->status == CHOLMOD_OUT_OF_MEMORY)
      throw RunError("not enough memory to factor a finite element model of " + std::to_string(m.view.ncol) +
                     " unknowns");
    if (c->status != CHOLMOD_OK)
      throw RunError("a finite element model is not held: its stiffness matrix is not positive definite");
  }
};

SparseCholesky::SparseCholesky(const SparseMatrix& m, const Freedoms& freedoms) : parts_(new Parts) {
  use_one_blas_thread();
  std::vector<int> node_of(static_cast<std::size_t>(freedoms.size()));
  Index64 first;  // of the displacements of each node that has some
  int nodes = 0;
  for (int n = 0; n < freedoms.nodes(); ++n) {
    bool free = false;
    for (int axis = 0; axis < 3; ++axis) {
      const int f = freedoms(n, axis);
      if (f < 0) continue;
      if (!free) first.push_back(f);
      free = true;
      node_of[static_cast<std::size_t>(f)] = nodes;
    }
    if (free) ++nodes;
  }
  first.push_back(freedoms.size());
  cholmod_common* c = &parts_->common.c;
  Index64 order;
  for (SuiteSparse_long node : order_nodes(m, node_of, nodes, c))
    for (SuiteSparse_long f = first[static_cast<std::size_t>(node)];
         f < first[static_cast<std::size_t>(node + 1)]; ++f)
      order.push_back(f);
  Upper upper(m);
  parts_->factor = cholmod_l_analyze_p(&upper.view, order.data(), nullptr, 0, c);
  parts_->factorize(upper);
}

void SparseCholesky::refactor(const SparseMatrix& m) {
  use_one_blas_thread();
  Upper upper(m);
  parts_->factorize(upper);
}

SparseCholesky::~SparseCholesky() = default;
SparseCholesky::SparseCholesky(SparseCholesky&&) noexcept = default;

Eigen::MatrixXd SparseCholesky::solve(const Eigen::MatrixXd& rhs) const {
  use_one_blas_thread();
  Eigen::MatrixXd solution(rhs.rows(), rhs.cols());
  bool failed = false;
  const Eigen::Index chunks = (rhs.cols() + chunk - 1) / chunk;
#pragma omp parallel for schedule(dynamic)
  for (Eigen::Index part = 0; part < chunks; ++part) {
    Common common;  // CHOLMOD's workspace is in here: one a thread
    const Eigen::Index from = part * chunk, count = std::min(chunk, rhs.cols() - from);
    cholmod_dense b{};
    b.nrow = b.d = static_cast<std::size_t>(rhs.rows());
    b.ncol = static_cast<std::size_t>(count);
    b.nzmax = b.nrow * b.ncol;
    b.x = const_cast<double*>(rhs.col(from).data());
    b.xtype = CHOLMOD_REAL;
    b.dtype = CHOLMOD_DOUBLE;
    cholmod_dense* x = cholmod_l_solve(CHOLMOD_A, parts_->factor, &b, &common.c);
    if (!x) {
#pragma omp atomic write
      failed = true;
      continue;
    }
    solution.middleCols(from, count) =
        Eigen::Map<const Eigen::MatrixXd>(static_cast<const double*>(x->x), rhs.rows(), count);
    cholmod_l_free_dense(&x, &common.c);
  }
  if (failed) throw RunError("not enough memory to solve a finite element model");
  return solution;
}

double SparseCholesky::factor_bytes() const {
  return 8.0 * static_cast<double>(parts_->factor->xsize);
}

}  // namespace trackbed::fem
