/// Bytes of a table's array.
pub(crate) fn bytes<T>(array: &[T]) -> u64 {
    size_of_val(array) as u64
}
