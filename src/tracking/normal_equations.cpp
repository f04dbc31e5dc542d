#include "laparoscope_servo/tracking/normal_equations.h"

#include <array>

namespace laparoscope_servo::tracking {

namespace {

// c * u^a v^b
struct Monomial {
  double c;
  int a;
  int b;
};

// J_k = gx P_k(u, v) + gy Q_k(u, v)
constexpr std::array<Monomial, 8> kP = {{{1, 0, 0}, {0, 0, 0}, {1, 0, 1}, {0, 0, 0}, {1, 1, 0}, {-1, 1, 0}, {-1, 2, 0}, {-1, 1, 1}}};
constexpr std::array<Monomial, 8> kQ = {{{0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {1, 1, 0}, {-1, 0, 1}, {-2, 0, 1}, {-1, 1, 1}, {-1, 0, 2}}};

// Where the moment of u^a v^b is kept; monomials are ordered by a, then by b.
constexpr int indexOfDegree4(int a, int b) { return a * 5 - a * (a - 1) / 2 + b; }
constexpr int indexOfDegree2(int a, int b) { return a * 3 - a * (a - 1) / 2 + b; }

double product(const Monomial& s, const Monomial& t, const double* moments) {
  const double c = s.c * t.c;
  return c == 0.0 ? 0.0 : c * moments[indexOfDegree4(s.a + t.a, s.b + t.b)];
}

double single(const Monomial& s, const double* moments) {
  return s.c == 0.0 ? 0.0 : s.c * moments[indexOfDegree2(s.a, s.b)];
}

// Sums of one row over u^a; a is the index.
struct RowSums {
  float xx[5], xy[5], yy[5];
  float xr[3], yr[3], xm[3], ym[3], x1[3], y1[3];
  float w, m, mm, r, mr;
};

void sumGeometry(const PixelRow& p, RowSums& s) {
  float xx0 = 0, xx1 = 0, xx2 = 0, xx3 = 0, xx4 = 0;
  float xy0 = 0, xy1 = 0, xy2 = 0, xy3 = 0, xy4 = 0;
  float yy0 = 0, yy1 = 0, yy2 = 0, yy3 = 0, yy4 = 0;
  float xr0 = 0, xr1 = 0, xr2 = 0, yr0 = 0, yr1 = 0, yr2 = 0, w_sum = 0;
#pragma omp simd reduction(+ : xx0, xx1, xx2, xx3, xx4, xy0, xy1, xy2, xy3, xy4, yy0, yy1, yy2, yy3, yy4, xr0, xr1, xr2, \
                               yr0, yr1, yr2, w_sum)
  for (int i = 0; i < p.count; ++i) {
    const float u = p.u0 + p.du * static_cast<float>(i);
    const float u2 = u * u;
    const float w = p.weight[i];
    const float wx = w * p.gx[i];
    const float wy = w * p.gy[i];
    const float r = p.residual[i];
    const float xx = wx * p.gx[i];
    const float xy = wx * p.gy[i];
    const float yy = wy * p.gy[i];
    const float xr = wx * r;
    const float yr = wy * r;
    xx0 += xx;
    xx1 += xx * u;
    xx2 += xx * u2;
    xx3 += xx * (u2 * u);
    xx4 += xx * (u2 * u2);
    xy0 += xy;
    xy1 += xy * u;
    xy2 += xy * u2;
    xy3 += xy * (u2 * u);
    xy4 += xy * (u2 * u2);
    yy0 += yy;
    yy1 += yy * u;
    yy2 += yy * u2;
    yy3 += yy * (u2 * u);
    yy4 += yy * (u2 * u2);
    xr0 += xr;
    xr1 += xr * u;
    xr2 += xr * u2;
    yr0 += yr;
    yr1 += yr * u;
    yr2 += yr * u2;
    w_sum += w;
  }
  s = {{xx0, xx1, xx2, xx3, xx4}, {xy0, xy1, xy2, xy3, xy4}, {yy0, yy1, yy2, yy3, yy4}, {xr0, xr1, xr2}, {yr0, yr1, yr2},
       {}, {}, {}, {}, w_sum, 0, 0, 0, 0};
}

void sumIllumination(const PixelRow& p, RowSums& s) {
  float xm0 = 0, xm1 = 0, xm2 = 0, ym0 = 0, ym1 = 0, ym2 = 0;
  float x10 = 0, x11 = 0, x12 = 0, y10 = 0, y11 = 0, y12 = 0;
  float m_sum = 0, mm = 0, r_sum = 0, mr = 0;
#pragma omp simd reduction(+ : xm0, xm1, xm2, ym0, ym1, ym2, x10, x11, x12, y10, y11, y12, m_sum, mm, r_sum, mr)
  for (int i = 0; i < p.count; ++i) {
    const float u = p.u0 + p.du * static_cast<float>(i);
    const float u2 = u * u;
    const float w = p.weight[i];
    const float m = p.intensity[i];
    const float wx = w * p.gx[i];
    const float wy = w * p.gy[i];
    const float wm = w * m;
    x10 += wx;
    x11 += wx * u;
    x12 += wx * u2;
    y10 += wy;
    y11 += wy * u;
    y12 += wy * u2;
    xm0 += wx * m;
    xm1 += wx * m * u;
    xm2 += wx * m * u2;
    ym0 += wy * m;
    ym1 += wy * m * u;
    ym2 += wy * m * u2;
    m_sum += wm;
    mm += wm * m;
    r_sum += w * p.residual[i];
    mr += wm * p.residual[i];
  }
  const float xm[] = {xm0, xm1, xm2}, ym[] = {ym0, ym1, ym2}, x1[] = {x10, x11, x12}, y1[] = {y10, y11, y12};
  for (int a = 0; a < 3; ++a) {
    s.xm[a] = xm[a];
    s.ym[a] = ym[a];
    s.x1[a] = x1[a];
    s.y1[a] = y1[a];
  }
  s.m = m_sum;
  s.mm = mm;
  s.r = r_sum;
  s.mr = mr;
}

}  // namespace

Eigen::Matrix<double, 1, 8> esmJacobianRow(double gx, double gy, double u, double v) {
  const double g3 = -(u * gx + v * gy);
  Eigen::Matrix<double, 1, 8> j;
  j << gx, gy, gx * v, gy * u, gx * u - gy * v, g3 - gy * v, g3 * u, g3 * v;
  return j;
}

void NormalEquations::reset(Light light) {
  light_ = light;
  sums_ = {};
  matrix_.setZero();
  vector_.setZero();
  if (light == Light::kConstant) matrix_(8, 8) = 1.0;
  if (light != Light::kGlobal) matrix_(9, 9) = 1.0;
}

void NormalEquations::add(const PixelRow& row) {
  RowSums s;
  sumGeometry(row, s);
  if (light_ != Light::kConstant) sumIllumination(row, s);
  double power = 1.0;  // v^b
  for (int b = 0; b <= 4; ++b, power *= row.v) {
    for (int a = 0; a + b <= 4; ++a) {
      const int k = indexOfDegree4(a, b);
      sums_.xx[k] += power * s.xx[a];
      sums_.xy[k] += power * s.xy[a];
      sums_.yy[k] += power * s.yy[a];
    }
    for (int a = 0; a + b <= 2; ++a) {
      const int k = indexOfDegree2(a, b);
      sums_.xr[k] += power * s.xr[a];
      sums_.yr[k] += power * s.yr[a];
      sums_.xm[k] += power * s.xm[a];
      sums_.ym[k] += power * s.ym[a];
      sums_.x1[k] += power * s.x1[a];
      sums_.y1[k] += power * s.y1[a];
    }
  }
  sums_.w += s.w;
  sums_.m += s.m;
  sums_.mm += s.mm;
  sums_.r += s.r;
  sums_.mr += s.mr;
}

void NormalEquations::endBlock() {
  block_jacobian_.setZero();
  for (int k = 0; k < 8; ++k) {
    for (int l = k; l < 8; ++l) {
      const double sum = product(kP[k], kP[l], sums_.xx) + product(kP[k], kQ[l], sums_.xy) + product(kQ[k], kP[l], sums_.xy) +
                         product(kQ[k], kQ[l], sums_.yy);
      matrix_(k, l) += sum;
      if (k != l) matrix_(l, k) += sum;
    }
    vector_[k] += single(kP[k], sums_.xr) + single(kQ[k], sums_.yr);
    block_jacobian_[k] = single(kP[k], sums_.x1) + single(kQ[k], sums_.y1);
  }
  block_weight_ = sums_.w;
  block_residual_ = sums_.r;
  if (light_ != Light::kConstant) {
    for (int k = 0; k < 8; ++k) {
      const double sum = single(kP[k], sums_.xm) + single(kQ[k], sums_.ym);
      matrix_(k, 8) += sum;
      matrix_(8, k) += sum;
    }
    matrix_(8, 8) += sums_.mm;
    vector_[8] += sums_.mr;
    block_jacobian_[8] = sums_.m;
  }
  if (light_ == Light::kGlobal) {
    matrix_.col(9).head<9>() += block_jacobian_.head<9>();
    matrix_.row(9).head<9>() += block_jacobian_.head<9>();
    matrix_(9, 9) += sums_.w;
    vector_[9] += sums_.r;
  } else if (light_ == Light::kLocal && sums_.w > 0.0) {
    matrix_ -= block_jacobian_ * block_jacobian_.transpose() / sums_.w;
    vector_ -= block_jacobian_ * sums_.r / sums_.w;
  }
  sums_ = {};
}

}  // namespace laparoscope_servo::tracking
