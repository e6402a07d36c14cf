//! What came of a run as words that read back to the last bit.

/// Something that is written as one cell or some.
pub trait Cells: Sized {
    /// Appends its cells.
    fn write(&self, to: &mut Vec<String>);

    /// Reads its cells; none where they are not such.
    fn read<'a>(from: &mut impl Iterator<Item = &'a str>) -> Option<Self>;

    /// From all cells of a row.
    fn of_row(cells: &[String]) -> Option<Self> {
        let mut cells = cells.iter().map(String::as_str);
        Self::read(&mut cells).filter(|_| cells.next().is_none())
    }
}

macro_rules! one_cell {
    ($($kind:ty),*) => {$(
        impl Cells for $kind {
            fn write(&self, to: &mut Vec<String>) {
                // The shortest digits that read back as the same number.
                to.push(self.to_string());
            }

            fn read<'a>(from: &mut impl Iterator<Item = &'a str>) -> Option<Self> {
                from.next()?.parse().ok()
            }
        }
    )*};
}

one_cell!(f64, u64, usize, bool, String);

impl<T: Cells> Cells for Option<T> {
    fn write(&self, to: &mut Vec<String>) {
        self.is_some().write(to);
        if let Some(value) = self {
            value.write(to);
        }
    }

    fn read<'a>(from: &mut impl Iterator<Item = &'a str>) -> Option<Self> {
        Some(if bool::read(from)? { Some(T::read(from)?) } else { None })
    }
}

impl<T: Cells, const N: usize> Cells for [T; N] {
    fn write(&self, to: &mut Vec<String>) {
        self.iter().for_each(|value| value.write(to));
    }

    fn read<'a>(from: &mut impl Iterator<Item = &'a str>) -> Option<Self> {
        let values: Vec<T> = (0..N).map_while(|_| T::read(from)).collect();
        values.try_into().ok()
    }
}

impl<T: Cells> Cells for Vec<T> {
    fn write(&self, to: &mut Vec<String>) {
        self.len().write(to);
        self.iter().for_each(|value| value.write(to));
    }

    fn read<'a>(from: &mut impl Iterator<Item = &'a str>) -> Option<Self> {
        (0..usize::read(from)?).map(|_| T::read(from)).collect()
    }
}

macro_rules! tuple {
    ($($name:ident $place:tt),*) => {
        impl<$($name: Cells),*> Cells for ($($name,)*) {
            fn write(&self, to: &mut Vec<String>) {
                $(self.$place.write(to);)*
            }

            fn read<'a>(from: &mut impl Iterator<Item = &'a str>) -> Option<Self> {
                Some(($($name::read(from)?,)*))
            }
        }
    };
}

tuple!(A 0, B 1);
tuple!(A 0, B 1, C 2);
tuple!(A 0, B 1, C 2, D 3);
