#pragma once

// Tsit5: the explicit Runge-Kutta pair of order 5 with an embedded estimate of
// order 4, last stage reused as the first of the next step, and a dense output
// of order 4 that needs no further stage.
// Source: Ch. Tsitouras, Runge-Kutta pairs of order 5(4) satisfying only the
// first column simplifying assumption, Comput. Math. Appl. 62 (2011) 770-775.
//
// One step from (t, y) with stages k_i = f(t + c_i h, y + h Σ_j a_ij k_j):
//   stages 0..5 give y₁ = y + h Σ b_j k_j; stage 6 is f(t + h, y₁) (a_6 = b).
// Error: h Σ e_j k_j, of order h⁵.
// Dense output at t + s h, s in [0, 1]: y + h Σ_j k_j Σ_{p=0..3} d_jp s^{p+1};
// it is continuously differentiable and meets y₁ at s = 1.

#include <array>

namespace steplap::tsit5 {

inline constexpr int k_order = 5;
inline constexpr int k_dense_order = 4;
inline constexpr int k_stages = 7;

inline constexpr std::array<double, 7> c = {0, 0.161, 0.327, 0.9, 0.9800255409045097, 1.0, 1.0};

// Row i holds a_ij, j < i.
inline constexpr std::array<std::array<double, 6>, 7> a = {{
    {{0, 0, 0, 0, 0, 0}},
    {{0.161, 0, 0, 0, 0, 0}},
    {{-0.008480655492356989, 0.335480655492357, 0, 0, 0, 0}},
    {{2.8971530571054935, -6.359448489975075, 4.3622954328695815, 0, 0, 0}},
    {{5.325864828439257, -11.748883564062828, 7.4955393428898365, -0.09249506636175525, 0, 0}},
    {{5.86145544294642, -12.92096931784711, 8.159367898576159, -0.071584973281401, -0.028269050394068383, 0}},
    {{0.09646076681806523, 0.01, 0.4798896504144996, 1.379008574103742, -3.290069515436081, 2.324710524099774}},
}};

inline constexpr std::array<double, 6> b = {0.09646076681806523, 0.01, 0.4798896504144996, 1.379008574103742, -3.290069515436081,
                                            2.324710524099774};

// The embedded weights of order 4 minus b (stage 6 counts with 1/66).
inline constexpr std::array<double, 7> e = {-0.001780011052225771443,
                                            -0.0008164344596567469032,
                                            0.007880878010261996010,
                                            -0.1447110071732629075,
                                            0.5823571654525552250,
                                            -0.4580821059291869467,
                                            1.0 / 66.0};

// Row j: coefficients of s, s², s³, s⁴ in the dense output's weight of stage j.
inline constexpr std::array<std::array<double, 4>, 7> d = {{
    {{1.0, -2.763706197274825911, 2.913255461821912744, -1.0530884977290216}},
    {{0, 0.13169999999999999727, -0.22339999999999999818, 0.1017}},
    {{0, 3.930296236894751529, -5.941033872131504735, 2.490627285651252793}},
    {{0, -12.41107716693367698, 30.33818863028232160, -16.54810288924490272}},
    {{0, 37.50931341651103920, -88.17890489476640110, 47.37952196281928122}},
    {{0, -27.89652628919728781, 65.09189467479367153, -34.87065786149660974}},
    {{0, 1.5, -4.0, 2.5}},
}};

} // namespace steplap::tsit5
