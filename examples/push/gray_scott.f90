! gray_scott EDGE STEPS EVERY DIRECTORY: the program of gray_scott.c in Fortran.
program gray_scott
  use weir
  implicit none

  real(c_float), allocatable, target :: u(:, :, :), v(:, :, :), next_u(:, :, :), next_v(:, :, :)
  character(len=1024) :: argument, directory
  character(kind=c_char, len=2), target :: name = 'v' // c_null_char
  type(weir_error) :: error
  type(c_ptr) :: push
  integer :: n, steps, every, step, z

  if (command_argument_count() /= 4) error stop 'gray_scott EDGE STEPS EVERY DIRECTORY'
  call get_command_argument(1, argument)
  read (argument, *) n
  call get_command_argument(2, argument)
  read (argument, *) steps
  call get_command_argument(3, argument)
  read (argument, *) every
  call get_command_argument(4, directory)

  allocate (u(n, n, n), v(n, n, n), next_u(n, n, n), next_v(n, n, n))
  u = 1
  v = 0
  u(n/2 - 3:n/2 + 4, n/2 - 3:n/2 + 4, n/2 - 3:n/2 + 4) = 0.5
  v(n/2 - 3:n/2 + 4, n/2 - 3:n/2 + 4, n/2 - 3:n/2 + 4) = 0.25

  do step = 1, steps
    push = c_null_ptr
    if (mod(step, every) == 0) push = begin(step)
    do z = 1, n
      call react(z)
      if (c_associated(push)) then
        call check(weir_push_slab(push, int(z - 1, c_int64_t), 1_c_int64_t, c_loc(next_v(1, 1, z)), c_null_ptr, error))
      end if
    end do
    if (c_associated(push)) call check(weir_push_end(push, error))
    call weir_push_free(push)
    u = next_u
    v = next_v
  end do

contains

  ! Plane z of the next step, periodic.
  subroutine react(z)
    integer, intent(in) :: z
    real(c_float) :: reaction, laplacian_u, laplacian_v
    integer :: x, y, x0, x1, y0, y1, z0, z1

    z0 = modulo(z - 2, n) + 1
    z1 = modulo(z, n) + 1
    do y = 1, n
      y0 = modulo(y - 2, n) + 1
      y1 = modulo(y, n) + 1
      do x = 1, n
        x0 = modulo(x - 2, n) + 1
        x1 = modulo(x, n) + 1
        laplacian_u = u(x0, y, z) + u(x1, y, z) + u(x, y0, z) + u(x, y1, z) + u(x, y, z0) + u(x, y, z1) - 6 * u(x, y, z)
        laplacian_v = v(x0, y, z) + v(x1, y, z) + v(x, y0, z) + v(x, y1, z) + v(x, y, z0) + v(x, y, z1) - 6 * v(x, y, z)
        reaction = u(x, y, z) * v(x, y, z) * v(x, y, z)
        next_u(x, y, z) = u(x, y, z) + 0.16 * laplacian_u - reaction + 0.035 * (1 - u(x, y, z))
        next_v(x, y, z) = v(x, y, z) + 0.08 * laplacian_v + reaction - (0.035 + 0.06) * v(x, y, z)
      end do
    end do
  end subroutine

  function begin(step) result(push)
    integer, intent(in) :: step
    type(c_ptr) :: push
    type(weir_volume) :: volume
    type(weir_convert_options) :: options
    character(len=1100) :: output

    call check(weir_volume_init(volume, c_sizeof(volume)))
    volume%extent = n
    volume%scalar_type = weir_float32
    volume%name = c_loc(name)
    call check(weir_convert_options_init(options, c_sizeof(options)))
    options%budget_kind = weir_budget_psnr
    options%budget = 50
    options%overwrite = 1
    write (output, '(a, a, i4.4, a)') trim(directory), '/v_', step, '.nvdb'
    call check(weir_push_begin(volume, options, trim(output) // c_null_char, push, error))
  end function

  subroutine check(status)
    integer(c_int32_t), intent(in) :: status

    if (status == weir_ok) return
    write (*, '(a)') weir_message(error)
    error stop 1
  end subroutine
end program
