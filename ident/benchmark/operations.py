"""How many floating-point operations a kernel takes: its own source, run in Python on numbers that count.

Counted as one each are a real addition, subtraction, multiplication, division, root and elementary function, a
complex number being two reals as on paper: a sum of two takes 2, a product 6, a quotient 11, a product with a real 2,
a modulus 4. Signs, comparisons, copies and whole numbers are free. The operations belong to the function that does
them, named by file and function, so that the parts of a kernel can be told apart.
"""

import cmath
import math
import operator
import sys
from collections import Counter
from collections.abc import Callable
from types import FrameType, FunctionType, SimpleNamespace
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

#: Operations of a sum, a product and a quotient by how many of both operands are complex; the quotient is by a real
#: where one is, and by a complex number where both are.
_SUM, _PRODUCT, _QUOTIENT = (1, 1, 2), (1, 2, 6), (1, 2, 11)
_MODULUS = 4


class Counting:
    """A number, real or complex, that enters what is done with it into a tally by function."""

    __slots__ = ("tally", "value")

    def __init__(self, value: complex, tally: Counter[str]) -> None:
        self.value, self.tally = value, tally

    def _made(self, value: complex, count: int, frames: int = 2) -> Self:
        self.tally[_name(sys._getframe(frames))] += count
        return type(self)(value, self.tally)

    def _with(self, other: Any, of: Callable[[Any, Any], complex], counts: tuple[int, int, int], turned: bool) -> Any:
        if isinstance(other, np.ndarray):
            return NotImplemented
        left, right = (_plain(other), self.value) if turned else (self.value, _plain(other))
        complexes = isinstance(left, complex) + isinstance(right, complex)
        by_complex = counts is _QUOTIENT and isinstance(right, complex)
        return self._made(of(left, right), counts[2 if by_complex else complexes], 3)

    def __add__(self, other: Any) -> Any:
        return self._with(other, operator.add, _SUM, False)

    def __radd__(self, other: Any) -> Any:
        return self._with(other, operator.add, _SUM, True)

    def __sub__(self, other: Any) -> Any:
        return self._with(other, operator.sub, _SUM, False)

    def __rsub__(self, other: Any) -> Any:
        return self._with(other, operator.sub, _SUM, True)

    def __mul__(self, other: Any) -> Any:
        return self._with(other, operator.mul, _PRODUCT, False)

    def __rmul__(self, other: Any) -> Any:
        return self._with(other, operator.mul, _PRODUCT, True)

    def __truediv__(self, other: Any) -> Any:
        return self._with(other, operator.truediv, _QUOTIENT, False)

    def __rtruediv__(self, other: Any) -> Any:
        return self._with(other, operator.truediv, _QUOTIENT, True)

    def __pow__(self, power: int) -> Self:
        return self._made(self.value**power, (power - 1) * _PRODUCT[2 if isinstance(self.value, complex) else 0])

    def __neg__(self) -> Self:
        return type(self)(-self.value, self.tally)

    def __abs__(self) -> Self:
        return self._made(abs(self.value), _MODULUS if isinstance(self.value, complex) else 0)

    def conjugate(self) -> Self:
        """The conjugate."""
        return type(self)(self.value.conjugate(), self.tally)

    @property
    def real(self) -> Self:
        """The real part."""
        return type(self)(self.value.real, self.tally)

    @property
    def imag(self) -> Self:
        """The imaginary part."""
        return type(self)(self.value.imag, self.tally)

    def __eq__(self, other: object) -> bool:
        return bool(self.value == _plain(other))

    def __hash__(self) -> int:
        return hash(self.value)

    def __lt__(self, other: Any) -> bool:
        return bool(_real(self) < _real(other))

    def __le__(self, other: Any) -> bool:
        return bool(_real(self) <= _real(other))

    def __gt__(self, other: Any) -> bool:
        return bool(_real(self) > _real(other))

    def __ge__(self, other: Any) -> bool:
        return bool(_real(self) >= _real(other))


def counting(values: Any, tally: Counter[str]) -> NDArray[Any]:
    """An array of the same shape whose numbers count."""
    array = np.asarray(values)
    made = np.empty(array.shape, dtype=object)
    for place, value in np.ndenumerate(array):
        made[place] = Counting(value.item(), tally)
    return made


def empty(*shape: int) -> NDArray[Any]:
    """An array of zeros that takes numbers that count."""
    made = np.empty(shape, dtype=object)
    made[...] = 0.0
    return made


def in_python(kernel: Callable[..., Any]) -> Callable[..., Any]:
    """The source of a kernel and of all kernels that it calls, to be run on numbers that count."""
    return _in_python(kernel, {})


def _in_python(kernel: Any, made: dict[int, Callable[..., Any]]) -> Callable[..., Any]:
    source: FunctionType = kernel.py_func
    if id(source) not in made:
        names: dict[str, Any] = dict(source.__globals__)
        copy = FunctionType(source.__code__, names, source.__name__, source.__defaults__)
        made[id(source)] = copy
        for name in source.__code__.co_names:
            value = names.get(name)
            if hasattr(value, "py_func"):
                names[name] = _in_python(value, made)
        names |= {"np": _NUMPY, "math": _MATH, "complex": _complex}
    return made[id(source)]


def _name(frame: FrameType) -> str:
    """Last word of the module, and the function."""
    return f"{frame.f_globals['__name__'].rpartition('.')[2]}.{frame.f_code.co_name}"


def _plain(value: Any) -> Any:
    return value.value if isinstance(value, Counting) else value


def _real(value: Any) -> float:
    return float(_plain(value))


def _elementary(of: Callable[[Any], complex]) -> Callable[[Any], Any]:
    """A function of one number, that of a number that counts being one operation of its caller."""

    def applied(value: Any) -> Any:
        if not isinstance(value, Counting):
            return of(value)
        value.tally[_name(sys._getframe(1))] += 1
        return Counting(of(value.value), value.tally)

    return applied


def _complex(real: Any, imag: Any = 0.0) -> Any:
    value = complex(_real(real), _real(imag))
    counts = next((each for each in (real, imag) if isinstance(each, Counting)), None)
    return value if counts is None else Counting(value, counts.tally)


def _sign(value: Any) -> float:
    return math.copysign(1.0, _real(value)) if _real(value) != 0.0 else 0.0


def _zeros(shape: Any, dtype: object = float) -> NDArray[Any]:
    return empty(*(shape if isinstance(shape, tuple) else (shape,)))


_ELEMENTARY = ("sqrt", "exp", "log", "log10", "sin", "cos", "tan", "asin", "acos", "atan", "erf", "erfc")
_MATH: Any = SimpleNamespace(
    **vars(math)
    | {name: _elementary(getattr(math, name)) for name in _ELEMENTARY}
    | {
        "isfinite": lambda value: math.isfinite(_real(value)),
        "hypot": lambda x, y: _MATH.sqrt(x * x + y * y),
    }
)
_NUMPY = SimpleNamespace(
    **vars(np)
    | {
        "zeros": _zeros,
        "empty": _zeros,
        "array": lambda values: np.array(values, dtype=object),
        "exp": _elementary(cmath.exp),
        "sign": _sign,
    }
)
