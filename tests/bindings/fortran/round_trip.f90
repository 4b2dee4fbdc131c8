! round_trip DIRECTORY: the calls of the module, from Fortran arrays to files and memory and back. Prints the bytes of
! the types and what files say of themselves; stops at the first value that is not the one that was given.
module callbacks
  use weir
  implicit none

contains

  subroutine count_call(user, pass, done_bytes, total_bytes) bind(c)
    type(c_ptr), value :: user, pass
    integer(c_int64_t), value :: done_bytes, total_bytes
    integer, pointer :: calls
    character(len=:), allocatable :: name_of_pass

    call c_f_pointer(user, calls)
    name_of_pass = weir_text(pass)
    if (done_bytes <= total_bytes .and. len(name_of_pass) >= 6) calls = calls + 1
  end subroutine
end module

program round_trip
  use weir
  use callbacks
  implicit none

  integer, parameter :: nx = 41, ny = 30, nz = 27
  real(c_float), target :: field(nx, ny, nz)
  integer(c_int16_t), target :: counts(nx, ny, nz)
  character(len=1024) :: directory
  character(kind=c_char, len=6), target :: name = 'field' // c_null_char
  type(weir_error) :: error
  type(weir_volume) :: volume
  type(weir_convert_options) :: options
  type(weir_input_options) :: input
  type(weir_grid_info) :: info
  integer, target :: called = 0
  integer :: x, y, z

  call get_command_argument(1, directory)
  print '(a)', 'version ' // weir_text(weir_version())
  print '(a, 5(1x, i0))', 'bytes', c_sizeof(error), c_sizeof(volume), c_sizeof(options), c_sizeof(input), c_sizeof(info)

  do z = 1, nz
    do y = 1, ny
      do x = 1, nx
        field(x, y, z) = value_at(x, y, z)
        counts(x, y, z) = int(x + 40 * y - 700 * (z / 2), c_int16_t)
      end do
    end do
  end do

  call set_up(weir_float32)
  volume%name = c_loc(name)
  options%encoding = weir_encoding_packed
  options%progress = c_funloc(count_call)
  options%user = c_loc(called)
  call check(weir_convert(volume, c_loc(field), c_null_ptr, options, path('a.nvdb'), error))
  if (called == 0) error stop 'progress was not called'
  call expect_field('a.nvdb')
  call push_field()
  call expect_field('b.nvdb')
  call in_memory()
  call from_raw_file()
  call failure()

contains

  real(c_float) function value_at(x, y, z)
    integer, intent(in) :: x, y, z

    value_at = real(x + 50 * y, c_float) / 8 + 1000 * real(z, c_float)
  end function

  ! A lossless conversion of values of this type.
  subroutine set_up(scalar_type)
    integer(c_int32_t), intent(in) :: scalar_type

    call check(weir_volume_init(volume, c_sizeof(volume)))
    volume%extent = [nx, ny, nz]
    volume%scalar_type = scalar_type
    call check(weir_convert_options_init(options, c_sizeof(options)))
    options%budget_kind = weir_budget_lossless
    if (volume%struct_size /= c_sizeof(volume) .or. options%struct_size /= c_sizeof(options)) error stop 'struct_size'
  end subroutine

  subroutine expect_field(file)
    character(len=*), intent(in) :: file
    type(c_ptr) :: grid
    integer(c_int64_t) :: lowest(3), past(3)
    real(c_float), allocatable :: box(:, :, :)
    real(c_float) :: value

    call check(weir_open(path(file), grid, error))
    call check(weir_grid_info_init(info, c_sizeof(info)))
    call check(weir_get_info(grid, info, error))
    print '(a, 8(1x, i0))', file // ' ' // weir_text(weir_grid_name(grid)), info%extent, info%index_min, &
      info%encoding, info%lossless
    if (index(weir_text(weir_grid_sidecar(grid)), '"weir_sidecar"') == 0) error stop 'sidecar'

    lowest = [3, 5, 7]
    past = [20, 6, nz]
    allocate (box(past(1) - lowest(1), past(2) - lowest(2), past(3) - lowest(3)))
    call check(weir_read_box(grid, lowest, past, box, size(box, kind=c_size_t), error))
    if (any(abs(box - field(4:20, 6:6, 8:nz)) > 0)) error stop 'weir_read_box'
    call check(weir_value(grid, [40_c_int64_t, 2_c_int64_t, 26_c_int64_t], value, error))
    if (abs(value - field(41, 3, 27)) > 0) error stop 'weir_value'
    call weir_close(grid)
  end subroutine

  ! The same in two slabs, the last planes first, the second with strides.
  subroutine push_field()
    type(c_ptr) :: push
    integer(c_int64_t), target :: stride(3)

    stride = 4 * [1, nx, nx * ny]
    options%progress = c_null_funptr
    options%backend = weir_backend_cpu
    options%preview = weir_preview_off
    call check(weir_push_begin(volume, options, path('b.nvdb'), push, error))
    call check(weir_push_slab(push, 10_c_int64_t, int(nz - 10, c_int64_t), c_loc(field(1, 1, 11)), c_null_ptr, error))
    if (weir_push_end(push, error) /= weir_error_usage) error stop 'planes are missing'
    call check(weir_push_slab(push, 0_c_int64_t, 10_c_int64_t, c_loc(field), c_loc(stride), error))
    call check(weir_push_end(push, error))
    call weir_push_free(push)
  end subroutine

  subroutine in_memory()
    type(c_ptr) :: buffer, grid
    real(c_float) :: values(2)

    call set_up(weir_int16)
    call check(weir_convert_to_memory(volume, c_loc(counts), c_null_ptr, options, buffer, error))
    call check(weir_open_memory(weir_buffer_data(buffer), weir_buffer_size(buffer), weir_buffer_sidecar(buffer), grid, &
                                error))
    call check(weir_get_info(grid, info, error))
    print '(a, 8(1x, i0))', 'memory ' // weir_text(weir_grid_name(grid)), info%extent, info%certified, &
      merge(1, 0, info%file_bytes == weir_buffer_size(buffer)), merge(1, 0, c_associated(weir_grid_data(grid)))
    call check(weir_sample(grid, weir_filter_trilinear, reshape([3.5, 4.5, 5.5, 40.5, 29.5, 26.5], [3, 2]), &
                           2_c_size_t, values, error))
    if (any(abs(values - [counts(4, 5, 6), counts(nx, ny, nz)]) > 0)) error stop 'weir_sample'
    call weir_close(grid)
    call weir_buffer_free(buffer)
  end subroutine

  subroutine from_raw_file()
    type(c_ptr) :: grid
    real(c_float) :: value
    integer :: unit

    open (newunit=unit, file=trim(directory) // '/counts.raw', access='stream', form='unformatted')
    write (unit) counts
    close (unit)
    call check(weir_input_options_init(input, c_sizeof(input)))
    input%extent = [nx, ny, nz]
    input%scalar_type = weir_int16
    input%roi_min = [8, 0, 0]
    input%roi_max = [nx, ny, 20]
    call check(weir_convert_file(path('counts.raw'), input, options, path('c.nvdb'), error))
    call check(weir_open(path('c.nvdb'), grid, error))
    call check(weir_get_info(grid, info, error))
    print '(a, 8(1x, i0))', 'file', info%extent
    call check(weir_value(grid, info%index_min + [1, 2, 3], value, error))
    if (abs(value - counts(10, 3, 4)) > 0) error stop 'weir_convert_file'
    call weir_close(grid)
  end subroutine

  subroutine failure()
    type(c_ptr) :: grid

    if (weir_open(path('none.nvdb'), grid, error) /= weir_error_input) error stop 'a status'
    if (error%status /= weir_error_input) error stop 'another status'
    print '(a)', weir_message(error)
    if (len(weir_text(c_null_ptr)) /= 0) error stop 'weir_text'
  end subroutine

  function path(file)
    character(len=*), intent(in) :: file
    character(len=:), allocatable :: path

    path = trim(directory) // '/' // file // c_null_char
  end function

  subroutine check(status)
    integer(c_int32_t), intent(in) :: status

    if (status == weir_ok) return
    print '(a)', weir_message(error)
    error stop 1
  end subroutine
end program
